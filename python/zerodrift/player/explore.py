"""`zd.explore`: sliders for parameters, and the film of the motion that they make."""

from __future__ import annotations

import html
import inspect
import secrets
from collections.abc import Callable, Mapping
from typing import Any, Unpack

from .. import units
from .._private import checks
from .._private.types import Display, ExploreOptions, SystemLike
from ..errors import MissingPackage, WrongType, WrongValue, ZerodriftError
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from .scene import Wanted
from .view import View

STEPS = 100         # of a slider
SHOWN = ("forces", "path", "graphs", "names", "speed")      # arguments of `view`; all others are those of `simulate`


class Exploration:
    """A motion for values of parameters; at the end of a notebook's cell it shows sliders above its film.

    Attributes
    ----------
    values : dict of str to float
        Present values of the parameters.
    solution : Solution or None
        The motion for these values; None if they allow none.
    film : View or None
        Its film.
    message : str
        The reason why there is no motion; empty if there is one.
    group : str
        Name by which its films find each other: a new one goes on at the time of the one before, as seen from the same side.
    """

    def __init__(self, made: Callable[[dict[str, float]], Any], t_span: Any, ranges: Mapping[str, tuple[float, float]],
                 values: Mapping[str, float], options: Mapping[str, Any], units_of: Mapping[str, str] | None = None) -> None:
        self._made, self._t_span, self.ranges, self.values = made, t_span, dict(ranges), dict(values)
        self._shown = {name: options[name] for name in SHOWN if name in options}
        self._settings = {name: value for name, value in options.items() if name not in SHOWN}
        self.solution: Solution | Any = None
        self.film: View | None = None
        self.message = ""
        self.group = secrets.token_hex(8)
        self._display, self._units = units.chosen(), units_of or {}
        self._run()

    def set(self, values: Mapping[str, float] | None = None, /, **named: float) -> Exploration:
        """Change values of parameters, and simulate again.

        Parameters
        ----------
        values : dict of str to float, optional
            Values by name, for names that Python does not take as keywords.
        **named
            Values by name.

        Returns
        -------
        Exploration
            Itself.

        Raises
        ------
        ValueError
            If a name is not that of a parameter.
        """
        for name, value in {**(values or {}), **named}.items():
            if name not in self.values:
                raise WrongValue(f"values must name parameters of this exploration, {', '.join(self.values)}, not {name!r}",
                                 "wrong-name")
            self.values[name] = checks.number(name, value)
        self._run()
        return self

    def _run(self) -> None:
        """Simulate; values that allow no motion leave the reason in `message`."""
        self.solution = self.film = None
        self.message = ""
        try:
            self.solution = simulate(self._made(self.values), self._t_span, **self._settings)
        except (ZerodriftError, ValueError) as error:
            self.message = str(error)
            return
        with units.display_units(self._display):
            self.film = View([self.solution], [self.solution.system.name], Wanted(**self._shown, group=self.group))

    def widget(self) -> Any:
        """Sliders above the film, as a widget of ipywidgets.

        A new film is laid behind the present one, which it asks for its time, and takes its place.

        Raises
        ------
        ImportError
            If ipywidgets is not installed.
        """
        try:
            import ipywidgets
        except ImportError:
            raise MissingPackage("sliders need ipywidgets, which is not installed: pip install 'zerodrift[notebook]'") from None
        pictures = [ipywidgets.HTML(self._picture()), ipywidgets.HTML(layout={"display": "none"})]
        with units.display_units(self._display):
            shown = {name: units.shown(self._units.get(name, "")) for name in self.ranges}
        names = {f"{name} [{of.unit}]" if of.unit else name: name for name, of in shown.items()}
        sliders = []
        for described, name in names.items():
            value, low, high = (each * shown[name].factor for each in (self.values[name], *self.ranges[name]))
            sliders.append(ipywidgets.FloatSlider(
                value=value, min=low, max=high, step=(high - low) / STEPS, description=described, readout_format=".4g",
                continuous_update=True, style={"description_width": "14em"}, layout={"width": "36em", "max_width": "100%"}))

        def moved(change: Any) -> None:
            name = names[change["owner"].description]
            self.set({name: change["new"] / shown[name].factor})
            pictures.reverse()
            pictures[0].value = self._picture()
            pictures[0].layout.display, pictures[1].layout.display = None, "none"

        for slider in sliders:
            slider.observe(moved, names="value")
        return ipywidgets.VBox([*sliders, *pictures])

    def _picture(self) -> str:
        """The film, or the reason for which there is none."""
        return f"<pre>{html.escape(self.message)}</pre>" if self.film is None else self.film.frame()

    def _ipython_display_(self) -> None:
        from IPython.display import display

        display(self.widget())

    def __repr__(self) -> str:
        values = ", ".join(f"{name} = {value:g}" for name, value in self.values.items())
        message = self.solution.message if self.solution is not None else self.message
        return f"<exploration of {values}: {message}>"


@units.displayed
def explore(system: SystemLike | Callable[..., SystemLike], parameters: Mapping[str, tuple[float, float]],
            t_span: float | tuple[float, float] = 10.0, *, display: Display | None = None,
            **options: Unpack[ExploreOptions]) -> Exploration:
    """Sliders that simulate again while they are dragged, above the film and its graphs.

    Parameters
    ----------
    system : system, Mechanism or callable
        A callable receives the parameters by name and returns a system or a Mechanism: it can vary lengths, as in
        ``zd.explore(zd.models.hoecken, {"coupler": (2.0, 3.0)})``.
    parameters : dict of str to (float, float)
        Range of each slider: names are those of `with_parameters`, or arguments of the callable. It starts at the system's own
        value, if that is within the range, otherwise in the middle.
    t_span : float or (float, float)
        As in `simulate`.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.
    **options
        ``forces``, ``path``, ``graphs``, ``names`` and ``speed`` are those of `view`; all others are those of `simulate`.

    Returns
    -------
    Exploration
        It shows itself at the end of a notebook's cell, which needs ipywidgets (extra ``notebook``); `Exploration.set` is the
        same without sliders.

    Raises
    ------
    ValueError, TypeError
        If there are no parameters, a range is not increasing, or a name is not a parameter of the system.

    Examples
    --------
    >>> import zerodrift as zd
    >>> crank = zd.explore(zd.models.slider_crank(), {"spring.stiffness": (0.5, 5.0)}, 2.0, step=0.01, graphs=["crank.angle"])
    >>> soft = crank.solution["crank.angle"][-1]
    >>> bool(crank.set({"spring.stiffness": 5.0}).solution["crank.angle"][-1] != soft)
    True
    """
    ranges = _ranges(parameters)
    if inspect.isroutine(system) or inspect.isfunction(system):
        own = {name: each.default for name, each in inspect.signature(system).parameters.items()}
        return Exploration(lambda values: system(**values), t_span, ranges, _first(ranges, own), options)
    made: Any = system
    whole = made.system() if hasattr(made, "system") else made
    unknown = [name for name in ranges if name not in whole.parameters]
    if unknown:
        raise WrongValue(f"parameters must be those of {whole.name}, {', '.join(whole.parameters)}, not {unknown[0]!r}",
                         "wrong-name")
    return Exploration(made.with_parameters, t_span, ranges, _first(ranges, whole.parameters), options, whole._parameter_units())


def _ranges(parameters: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """The ranges, as pairs of increasing numbers."""
    if not isinstance(parameters, Mapping) or not parameters:
        raise WrongType("parameters must be a dict of ranges by name, such as {'rod.mass': (0.5, 2.0)}, not "
                        f"{checks.shown(parameters)}")
    found = {}
    for name, given in parameters.items():
        try:
            low, high = (float(each) for each in given)
        except (TypeError, ValueError):
            raise WrongType(f"the range of {name!r} must be two numbers, not {checks.shown(given)}") from None
        if not low < high < float("inf") or low == float("-inf"):
            raise WrongValue(f"the range of {name!r} must increase and be finite, not {checks.shown(given)}", "not-increasing")
        found[name] = low, high
    return found


def _first(ranges: Mapping[str, tuple[float, float]], own: Mapping[str, Any]) -> dict[str, float]:
    """The system's own values where these lie in the ranges, otherwise the middles."""
    return {name: float(own[name]) if isinstance(own.get(name), int | float) and low <= own[name] <= high else (low + high) / 2
            for name, (low, high) in ranges.items()}
