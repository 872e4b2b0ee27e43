"""Every notebook runs, and is committed with the outputs of a run."""

import pytest

import tolerances as tol
from covering import WHOLE
from support import ROOT

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*/*.ipynb"))


def read(path):
    return pytest.importorskip("nbformat").read(path, as_version=4)


# Parts of the longest notebooks, of which the last cells assert the same; all of them with ZERODRIFT_PRODUCTS=1.
THINNED = {
    "speed_against_accuracy": {"in SCENES.items()}": "in list(SCENES.items())[:3]}"},
    "why_does_a_bicycle_stay_up": {"np.linspace(0.0, 10.0, 61)": "np.linspace(0.0, 10.0, 61)[::4]",
                                   "np.linspace(0.5, 12.0, 47)": "np.linspace(0.5, 12.0, 47)[::5]"},
    "andrews": {"np.arange(3, 12)": "np.arange(3, 12, 2)"},
    "stability_at_the_extremes": {
        "np.geomspace(1, 3000, 12)": "np.geomspace(1, 3000, 12)[::2]",
        "np.geomspace(0.002, 0.05, 7)": "np.geomspace(0.002, 0.05, 7)[::2]",
        "STARTS = (np.pi / 2, 1.0, 2.0)": "STARTS = (np.pi / 2, 1.0)",
        "np.geomspace(1, 1000, 60)": "np.geomspace(1, 1000, 60)[::4]",
        "np.logspace(-10, -1, 10)": "np.logspace(-10, -1, 10)[::3]",
        "len(outcomes) == 800": "len(outcomes) == 320"}}


def shortened(path):
    """A notebook whose studies of work and precision time each run once: what it asserts of them are evaluations and errors."""
    notebook, changes = read(path), {"rounds=ROUNDS": "rounds=1"} | ({} if WHOLE else THINNED.get(path.stem, {}))
    sources = [cell.source for cell in code_cells(notebook)]
    assert all(any(part in source for source in sources) for part in THINNED.get(path.stem, ()))
    for cell in code_cells(notebook):
        for part, shorter in changes.items():
            cell.source = cell.source.replace(part, shorter)
    return notebook


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def path(request):
    return request.param


def test_there_is_a_notebook_for_each_figure():
    assert {f"figure_{n}" for n in range(5, 10)} <= {path.stem for path in NOTEBOOKS}


@pytest.fixture(scope="module")
def client():
    """One kernel for all notebooks that a process runs, as its start and its imports take longer than most of them."""
    nbformat, nbclient, utils = map(pytest.importorskip, ("nbformat", "nbclient", "jupyter_core.utils"))
    manager = nbclient.NotebookClient(nbformat.v4.new_notebook()).create_kernel_manager()
    made = nbclient.NotebookClient(nbformat.v4.new_notebook(), km=manager, timeout=tol.HUNG)
    yield made
    if made.kc:
        made.kc.stop_channels()
    if manager.has_kernel:
        utils.run_sync(manager.shutdown_kernel)(now=True)


@pytest.mark.filterwarnings("default")      # what Jupyter warns of is not ours
def test_notebook_runs(path, client, tmp_path):
    """The last cell asserts what the notebook states, so running it is the test; it needs no other file of the repository, and
    no name of the notebook before it.
    """
    client.nb = shortened(path)
    first = code_cells(client.nb)[0]
    first.source = f"%reset_selective -f ^[^_]\n__import__('os').chdir({str(tmp_path)!r})\n{first.source}"
    client.execute()


@pytest.mark.skipif((ROOT / "PKG-INFO").exists(), reason="a source distribution has notebooks without their outputs")
def test_notebook_is_committed_as_executed(path):
    cells = code_cells(read(path))
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error" or output.get("name") == "stderr"]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert "assert" in cells[-1].source
    assert path.stat().st_size < 1_000_000
