"""Recorded robots judged: contacts, permit rules, assumptions of a shield, and what is not judged."""
