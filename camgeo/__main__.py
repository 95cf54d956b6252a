"""`python -m camgeo`: the command line."""

import sys

from camgeo.cli import main

if __name__ == "__main__":
    sys.exit(main())
