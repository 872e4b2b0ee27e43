"""Random systems of random rank through every formulation, as many as told: ``python tests/stress/random_systems.py 10000``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from random_ranks import CHECKS


def main(count):
    """Each check on as many seeds; exits with the number of failures."""
    failures = 0
    for name, check in CHECKS.items():
        compared = 0
        for seed in range(count):
            try:
                compared += check(seed)
            except Exception as error:
                failures += 1
                print(f"{name}, seed {seed}: {type(error).__name__}: {error}")
        print(f"{name}: {compared} of {count} compared")
    return failures


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000) > 0)
