"""All models of `zerodrift.models` in motion, as ``python -m zerodrift gallery`` and the gallery of the documentation show them.

>>> from zerodrift import gallery
>>> gallery.exhibit("jansen").lines
['m = zd.models.jansen()', 'sol = zd.simulate(m, 1, step=0.005)', 'zd.plot.animate(sol, speed=0.4, path="F")']
"""

from .exhibits import Exhibit, exhibit, exhibits
from .films import film
from .page import write

__all__ = ["Exhibit", "exhibit", "exhibits", "film", "write"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
