"""The program: ``python -m breakline``."""

import signal
import sys

from ._breakline import main as run


def main() -> int:
    """Run the command line with the arguments of this process."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the program has no Python to return to
    return run(["breakline", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
