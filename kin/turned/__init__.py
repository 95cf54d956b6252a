"""Tracks of rollers that run round a turning body, and programs for machines that turn it under a cutter."""
