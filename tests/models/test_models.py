"""What every model of `zd.models` can do; the motion of each is compared in the file of its name."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from every_model import LINKAGES, MODELS


@pytest.fixture(params=[*MODELS, *LINKAGES])
def model(request):
    return MODELS[request.param]() if request.param in MODELS else LINKAGES[request.param]().system()


def test_check(model):
    report = zd.check(model)
    assert report, report


def test_drawing(model):
    points = model.points(model.p0)
    assert points.ndim == 2
    assert points.shape[1] == 2
    assert np.isfinite(points[~np.isnan(points).all(axis=1)]).all()      # where the pen is lifted, both are nan


def test_pickling(model):
    again = pickle.loads(pickle.dumps(model))
    ends = [zd.simulate(system, 0.01, step=1e-4).p[-1] for system in (model, again)]
    assert np.array_equal(*ends)


def test_every_model_is_tried():
    assert set(zd.models.__all__) <= {*MODELS, *LINKAGES}


def test_without_sympy():
    """What is needed is said, and only when it is needed."""
    code = ("import sys; sys.modules['sympy'] = None\nimport zerodrift as zd\n"
            "try:\n    zd.models.andrews\nexcept ImportError as error:\n    print(error)")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'zerodrift[symbolic]'" in done.stdout
