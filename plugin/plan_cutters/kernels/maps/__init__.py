"""All free tilts, with certified ends. May use: search and what that uses."""
