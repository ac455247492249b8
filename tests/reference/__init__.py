"""A second evaluation of the laws, written from the specification for the tests."""
