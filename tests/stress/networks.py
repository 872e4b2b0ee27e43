"""Random networks of bodies through formulations, as many as told: ``python tests/stress/networks.py 2000 [formulation ...]``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from random_networks import check_acceleration
from support import FORMULATIONS


def main(count, formulations):
    """Each formulation on as many seeds; exits with 1 where any differs from dense equations."""
    failures = 0
    for formulation in formulations or FORMULATIONS:
        compared = 0
        for seed in range(count):
            try:
                compared += check_acceleration(seed, formulation)
            except Exception as error:
                failures += 1
                print(f"{formulation}, seed {seed}: {type(error).__name__}: {error}")
        print(f"{formulation}: {compared} of {count} compared", flush=True)
    return failures


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000, sys.argv[2:]) > 0)
