"""Processes of this program that work for another one: how they begin, what they know, what they may take, and how they end."""
