"""Plans are compared: what was lost and won from one to another, as words, pages and lines of continuous integration."""
