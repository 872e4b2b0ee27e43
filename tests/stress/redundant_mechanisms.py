"""Random mechanisms with welds, braces, doubled joints and idle loops against a dense model. Writes redundant_mechanisms.md.

    OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support \
        python tests/stress/redundant_mechanisms.py [many [processes [commit [s]]]]

Every second one is in space. Each is run in joint and in absolute coordinates, by each formulation in turn; at three states of
each motion the residuals, the rank (by singular values) and the accelerations are those of plain NumPy, and both motions are the
same. Refusals are counted by their reason. After s seconds it ends with those that are done.
"""

import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import zerodrift as zd
from mechanisms.redundant_mechanisms import outcome

TABLE = Path(__file__).with_suffix(".md")
FINE_WORDS = ("agrees with the model", "agree")


def tried(seed):
    """Findings of one seed; an error of another kind is a finding, too."""
    try:
        return outcome(seed)
    except Exception as error:      # to be listed, and mended
        return "", [[f"unexpected: {type(error).__name__}", str(error)[:160]]]


def page(found, commit, remark):
    """Lines of the table, from findings (seed, formulation, [[finding, details], ...])."""
    counts, listed, singular = Counter(), [], 0
    for seed, formulation, words in found:
        place = ("plane", "space")[seed % 2]
        counts.update(f"{place}, {word}" for word, _ in words)
        singular += any("singular" in details for _, details in words)
        listed += [f"| {seed} | {place}, {formulation}, {word} | {details} |" for word, details in words
                   if not word.endswith(FINE_WORDS)]
    commit = f", commit {commit}" if commit else ""
    return [f"# {len(found)} random mechanisms with redundant constraints", "",
            f"Written by `tests/stress/redundant_mechanisms.py`, zerodrift {zd.__version__}{commit}, "
            f"{time.strftime('%d %B %Y')}, {remark}.", "",
            "| finding | how many |", "|---|---|", *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
            f"{singular} of the mechanisms come near a singular pose (smallest singular value below 1e-4 of the largest).", "",
            "| seed | finding | what |", "|---|---|---|", *listed]


def main():
    """Runs them and writes the table."""
    many, processes, seconds = (int(sys.argv[i]) if len(sys.argv) > i else default
                                for i, default in ((1, 2000), (2, 1), (4, 10**6)))
    begin, found = time.time(), []
    with ProcessPoolExecutor(processes) as pool:
        for seed, (formulation, words) in enumerate(pool.map(tried, range(many), chunksize=5)):
            found.append((seed, formulation, words))
            if seed % 50 == 49:
                print(seed + 1, f"{time.time() - begin:.0f} s", flush=True)
            if time.time() > begin + seconds:
                pool.shutdown(wait=False, cancel_futures=True)
                break
    commit = sys.argv[3] if len(sys.argv) > 3 else ""
    lines = page(found, commit, f"{time.time() - begin:.0f} s in {processes} processes beside other work")
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
