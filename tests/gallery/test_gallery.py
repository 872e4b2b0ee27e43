"""Films of all models, the page that shows them, and a model that is missing in the table."""

import io
import re
import sys

import numpy as np
import pytest
from PIL import Image

from support import refused
from zerodrift import gallery, models
from zerodrift.__main__ import main
from zerodrift.gallery.exhibits import TABLE, by_itself


def frames_of(data):
    """The pictures of an animated PNG file, and their duration in ms."""
    picture = Image.open(io.BytesIO(data))
    found = []
    for i in range(picture.n_frames):
        picture.seek(i)
        found.append(np.asarray(picture.convert("RGB")))
    return found, picture.info["duration"]


def test_every_model_is_shown_and_nothing_else():
    known = [name for name in models.__all__ if callable(getattr(models, name))]
    assert len(known) == 41
    assert [each.name for each in gallery.exhibits()] == known
    assert sorted(each.name for each in TABLE) == sorted(known)
    for each in gallery.exhibits():
        assert each.see.endswith(".")
        assert len(each.see) < 160
        assert f"def {each.name}(" in each.source
        assert '"""' not in each.source
        assert not re.search(r"^(from|import) ", each.source, flags=re.MULTILINE)


@pytest.mark.parametrize("name", ["bicycle", "cam_follower", "planetary_gear", "quarter_car", "hookes_joint"])
def test_a_film_moves(name):
    """The notebook shows all of them. Frames are different, and pictures are not empty."""
    pictures, duration = frames_of(gallery.film(gallery.exhibit(name), frames=3))
    assert len(pictures) == 3
    assert {picture.shape for picture in pictures} == {(180, 240, 3)}
    assert (pictures[0] != pictures[1]).any()
    assert all((picture < 128).any() for picture in pictures)
    assert 1.0 < 3 * duration / 1000 < 5.0


def test_the_lines_are_those_that_are_run():
    """The code printed beside a film makes the motion of the film."""
    exhibit, names = gallery.exhibit("four_bars"), {}
    assert exhibit.lines[0] == "m = zd.models.four_bars()"
    exec("\n".join(["import zerodrift as zd", *exhibit.lines[:2]]), names)
    assert np.array_equal(names["sol"].p, exhibit.run().p)
    assert gallery.exhibit("pantograph").lines[2] == 'zd.plot.animate(sol, speed=0.4, path=["Q", "P"])'


def test_the_command_writes_films_and_a_page(tmp_path, monkeypatch, capsys):
    """With two models and three frames, as all take a minute."""
    pytest.importorskip("sympy")
    few = [gallery.exhibit("jansen"), gallery.exhibit("watt")]
    monkeypatch.setattr("zerodrift.gallery.page.exhibits", lambda: few)
    monkeypatch.setattr("zerodrift.gallery.page.FRAMES", 3)
    assert main(["gallery", "--out", str(tmp_path / "new" / "films")]) == 0
    assert "index.html" in capsys.readouterr().out
    page = (tmp_path / "new" / "films" / "index.html").read_text()
    for exhibit in few:
        pictures, _ = frames_of((tmp_path / "new" / "films" / f"{exhibit.name}.png").read_bytes())
        assert len(pictures) == 3
        assert f'src="{exhibit.name}.png"' in page
        assert exhibit.see in page
        assert f"zd.models.{exhibit.name}()" in page
    assert page.count("<section") == page.count("</section>") == 2
    (tmp_path / "file").write_text("in the way")
    assert main(["gallery", "--out", str(tmp_path / "file")]) == 1
    assert f"cannot write to {tmp_path / 'file'}" in capsys.readouterr().err


def test_without_sympy_the_command_says_what_to_install(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "sympy", None)
    assert main(["gallery", "--out", str(tmp_path / "films")]) == 1
    assert capsys.readouterr().err.endswith("are expressions of SymPy: pip install 'zerodrift[symbolic]' [zd:missing-package]\n")
    assert not (tmp_path / "films").exists()


def test_a_model_that_is_in_no_table_is_shown_by_its_docstring_and_its_motor():
    def new():
        """A leg that turns
        slowly.

        More.
        """
        return models.jansen(speed=-np.pi)

    shown = by_itself("new", new)
    assert (shown.see, shown.span, shown.step, shown.speed) == ("A leg that turns slowly.", 2.0, 0.005, 0.8)
    assert by_itself("still", models.four_bar).span == 2.0


def test_what_is_refused():
    with refused("unknown-choice", "^name must.*'leg'.*andrews"):
        gallery.exhibit("leg")
    with refused("wrong-type", "exhibit"):
        gallery.film("jansen")
    with refused("out-of-range", "frames.*between 2"):
        gallery.film(gallery.exhibit("watt"), frames=1)
