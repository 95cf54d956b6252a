"""Exit statuses of the commands; of several recipes the highest."""

OK = 0  # every check holds
FAILED = 1  # a curve exists, and a check fails
WRONG = 2  # the recipe or the call is wrong, no such curve exists, or a tolerance cannot be held
SURROUNDINGS = 3  # the disk, a missing package, another program that does not answer
INTERRUPTED = 130  # as a shell reports SIGINT


def of_run(*, ok: bool, left_out: bool) -> int:
    """Exit status of a run by whether all that it checked holds, and whether a missing package left files out."""
    return FAILED if not ok else SURROUNDINGS if left_out else OK
