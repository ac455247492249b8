"""The `contact` command: from a cell file to its report."""
