"""Settings and the call of Exudyn's solver: what all comparisons with it share."""

import time

import exudyn as exu


def solved(build, described, solver, algebra, steps, count):
    """The system, what `build` gives of it, and time of the call of the solver, s.

    `solver` is its type, the spectral radius, index 2 and Newmark's method; `count` spans of the samples have `steps` each.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    built = build(mbs, described)
    kind, radius, index_2, newmark = solver
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = described.t_end / count
    settings.linearSolver.solverType = algebra
    integration = settings.timeIntegration
    integration.endTime, integration.verboseMode = described.t_end, 0
    integration.numberOfSteps = steps * count
    integration.newton.useModifiedNewton = True
    integration.generalizedAlpha.spectralRadius = radius
    integration.generalizedAlpha.useIndex2Constraints, integration.generalizedAlpha.useNewmark = index_2, newmark
    start = time.process_time()
    mbs.SolveDynamic(settings, solverType=kind)
    return mbs, built, time.process_time() - start
