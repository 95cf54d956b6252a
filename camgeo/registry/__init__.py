"""Capabilities as the core sees them: their labels, the record of each, and tables that all of them add to."""
