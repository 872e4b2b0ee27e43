"""Runs of an ensemble as the core makes them: in one call, from tables."""

import numpy as np

from zerodrift._private import gateway
from zerodrift.ensembles.batch import batch_of
from zerodrift.ensembles.part import BY_CORE, IN_LANES
from zerodrift.ensembles.plan import checked
from zerodrift.ensembles.run_range import run_range
from zerodrift.ensembles.runs import Runs
from zerodrift.runs.arguments.settings import VECTOR_UNITS

UNITS = VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]
LANES, ALONE = IN_LANES, BY_CORE


def plan_of(system, span, parameters=None, p0=None, v0=None, names=None, **options):
    runs = Runs(system, parameters, p0, v0, None, (), assembles=True)
    plan = checked(runs, span, names, None, keeps=False, **options)
    assert batch_of(plan) is not None
    return plan


def made(plan, first=0, last=None):
    return run_range(plan, first, plan.runs.count if last is None else last)


def rows_of(part, name):
    """Run by run."""
    return np.split(part.arrays[name], np.cumsum(part.rows)[:-1])
