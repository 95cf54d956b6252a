"""A file each for the formats of files: all that is known of a format, with its writer."""
