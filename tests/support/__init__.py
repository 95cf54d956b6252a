"""What several tests share: places, recipes and files for them, and oracles by other means than the program's."""
