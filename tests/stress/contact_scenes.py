"""Random scenes with contacts against time stepping. Writes contact_scenes.md, or contact_scenes_in_space.md.

    export OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support
    python tests/stress/contact_scenes.py plane|space FILE [many [s [commit]]]

Findings are added to FILE, one line of JSON for each seed, and those that are in it are not made again; after s seconds it ends.
Each scene has its own process: a crash is a finding. See `tests/contact/random_scenes.py` and `space_scenes.py`: kinds of
scenes, laws, and the error up to which both must agree.
"""

import json
import multiprocessing
import re
import sys
import time
from collections import Counter
from pathlib import Path

import zerodrift as zd
from contact import random_scenes, space_scenes

TABLES = {"plane": (random_scenes, "contact_scenes.md"), "space": (space_scenes, "contact_scenes_in_space.md")}
LIMIT = 120     # s of a scene


def _send(pipe, scenes, seed):
    try:
        pipe.send(scenes.outcome(seed))
    except Exception as error:      # to be listed, and mended
        pipe.send(("error", {"why": f"{type(error).__name__}: {error}"}))


def tried(scenes, seed):
    """Finding and details of one seed, made in a process of its own."""
    here, there = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(target=_send, args=(there, scenes, seed))
    process.start()
    there.close()
    try:
        found = here.recv() if here.poll(LIMIT) else ("slow", {"why": f"more than {LIMIT} s"})
    except EOFError:
        found = "crashed", {}
    if process.is_alive() and found[0] == "slow":
        process.kill()
    process.join()
    return found


def reason(why):
    """Sentence of a refusal, without names and numbers."""
    why = re.sub(r"at t = \S+ \(step [^)]*\): |\[zd:.*\]|; .*", "", why)
    return re.sub(r"-?\d+(\.\d+)?(e[+-]?\d+)?", "...", re.sub(r"'[^']*'", "'...'", why)).strip().replace("|", "\\|")


def page(found, commit):
    """Lines of the table, from findings by seed."""
    counts = Counter(each["finding"] for each in found.values())
    kinds = sorted({each.get("kind", "?") for each in found.values()})
    by_kind = Counter((each.get("kind", "?"), each["finding"]) for each in found.values())
    words = sorted(counts)
    reasons = Counter(reason(each.get("why", "")) for each in found.values() if each["finding"] in ("refused", "error"))
    compared = sum(each.get("compared", 0) for each in found.values() if each["finding"] == "agree")
    listed = [f"| {seed} | {each.get('kind', '?')} | {each['finding']} | {_details(each)} |"
              for seed, each in sorted(found.items()) if each["finding"] != "agree"]
    commit = f", commit {commit}" if commit else ""
    return [f"# {len(found)} random scenes with contacts", "",
            f"Written by `tests/stress/contact_scenes.py`, zerodrift {zd.__version__}{commit}, {time.strftime('%d %B %Y')}.", "",
            f"Scenes that agree were compared for {compared:.0f} s together, of {counts['agree']} s that they last.", "",
            "| kind | " + " | ".join(words) + " |", "|---" * (len(words) + 1) + "|",
            *(f"| {kind} | " + " | ".join(str(by_kind[kind, word]) for word in words) + " |" for kind in kinds),
            "| all | " + " | ".join(str(counts[word]) for word in words) + " |", "",
            "| reason | how many |", "|---|---|", *(f"| {why} | {count} |" for why, count in reasons.most_common()), "",
            "| seed | kind | finding | what |", "|---|---|---|---|", *listed]


def _details(each):
    if "away" not in each:
        return re.sub(r"; zd\..*| \[zd:.*", "", each.get("why", "").replace("\n", " ")).replace("|", "\\|")
    return (f"{each['away']:.1e} away at t = {each['at']:g}, of an error of {each['error']:.1e}; "
            f"{each.get('phases')} phases in {each['s']:.1f} s")


def main():
    """Runs the scenes and writes the table."""
    (scenes, table), file = TABLES[sys.argv[1]], Path(sys.argv[2])
    many, seconds = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((3, 1000), (4, 10**6)))
    begin = time.time()
    lines = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    found = {each.pop("seed"): each for each in lines}
    scenes.outcome(0)       # imports, which all processes then have
    for seed in range(many):
        if seed in found or time.time() > begin + seconds:
            continue
        finding, details = tried(scenes, seed)
        found[seed] = {"finding": finding, **details}
        with file.open("a") as out:
            out.write(json.dumps({"seed": seed, **found[seed]}) + "\n")
    lines = page(found, sys.argv[5] if len(sys.argv) > 5 else "")
    Path(__file__).with_name(table).write_text("\n".join(lines) + "\n")
    print("\n".join(lines[:40]))


if __name__ == "__main__":
    main()
