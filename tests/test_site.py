"""The site: it builds without a warning, and the code of its pages runs."""

import re
import subprocess
import sys

import matplotlib
import pytest

from support import ROOT, environment_of_tests

PAGES = ROOT / "notebooks"


@pytest.mark.parametrize("page", ["index", "how_to", "tried"])
def test_code_of_pages_runs(page, tmp_path, monkeypatch, capsys):
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (PAGES / f"{page}.md").read_text(encoding="utf-8"), re.DOTALL)
    assert blocks
    names = {}
    for block in blocks:
        exec(compile(block, f"{page}.md", "exec"), names)


def test_the_site_builds_without_a_warning(tmp_path):
    for package in ("sphinx", "myst_nb", "numpydoc", "pydata_sphinx_theme", "latex2mathml"):
        pytest.importorskip(package)
    done = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "-n", "-d", str(tmp_path / "doctrees"), str(PAGES),
                           str(tmp_path / "site")], capture_output=True, text=True, check=False, env=environment_of_tests())
    assert (done.returncode, done.stderr) == (0, "")
    for page in ("index", "how_to", "generated/errors", "generated/api/zerodrift.simulate"):
        assert (tmp_path / "site" / f"{page}.html").is_file()
    equations = (tmp_path / "site" / "computation.html").read_text(encoding="utf-8")
    assert "<math" in equations
    for written in (tmp_path / "site").rglob("*.html"):
        page = written.read_text(encoding="utf-8")
        assert not re.search(r"<(script|img|link)[^>]*(src|href)=.https?://[^>]*(\.js|\.css|\.png)", page), written.name
        assert not re.search(r"<img(?![^>]*alt=)", page), written.name
