"""The program: ``python -m breakline``."""

import os
import sys

from ._breakline import main as run


def main() -> int:
    """Run the command line with the arguments of this process."""
    try:
        return run(["breakline", *sys.argv[1:]])
    except KeyboardInterrupt:
        os._exit(130)  # at once: the program still works


if __name__ == "__main__":
    sys.exit(main())
