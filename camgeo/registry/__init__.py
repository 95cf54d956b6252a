"""Capabilities and formats as the core sees them: labels, questions and answers, tables that all of them add to."""
