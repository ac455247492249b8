"""The `program` command: from a program file to its report."""
