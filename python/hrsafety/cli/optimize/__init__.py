"""The `optimize` command: a gain search from a file to a page."""
