"""From a file and an intent to a verdict."""
