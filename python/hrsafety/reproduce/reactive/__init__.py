"""Following, sound and sonar."""
