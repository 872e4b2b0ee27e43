"""The order of the core's rooms, from the public interface up to the outer loop: a file uses only what stands in lower lines."""

ORDER = (
    ("include/zerodrift",),
    ("workspace", "zerodrift"),
    ("linalg",),
    ("linalg/sparse",),
    ("point",),
    ("point/sparse",),
    ("constraints", "contact"),
    ("formulations/sparse", "step_limits"),
    ("formulations",),
    ("motion",),
    ("analysis",),
    ("integrators", "safeguards"),
    ("integrators/radau", "corrections", "state"),
    ("paths",),
    ("step",),
    ("output",),
    ("run/arguments",),
    ("run",),
    ("simulate", "operations"),
    ("batch/lanes",),
    ("batch",),
    ("batch/open",),
)


def height(room):
    """The line of a room from below; rooms without one (systems, tables, bindings) are read through tables and stand lowest."""
    return next((line for line, rooms in enumerate(ORDER) if room in rooms), 0)
