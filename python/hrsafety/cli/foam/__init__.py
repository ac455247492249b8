"""The `foam` command: from recorded tests to a page."""
