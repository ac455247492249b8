"""The `sweep` command: a sweep from a file to a page."""
