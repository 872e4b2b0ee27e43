"""Residuals of the constraints and the matrices of a system as C in double-double arithmetic: part of `zd_precise`."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

from .writers import indented

TERMS = ("A", "M", "C", "Phi", "Phi_t")
NAME = re.compile(r"\b[yz]\d+\b")         # of a value, or of its coefficient
DEFINITION = re.compile(r"const zd_number ([yz]\d+) = ")
SIGNATURE = ["ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,",
             "    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,",
             "    double *restrict C, double *restrict A)"]
WRAPPED = """\
static int precise_series(const double *numbers, int order, const double *t, const double *p, const double *v, double *p_series,
                          double *v_series, double *scratch)
{
    return evaluate(numbers, (const double *)0, order, *(const zd_number *)t, (const zd_number *)p, (const zd_number *)v,
                    (zd_number *)p_series, (zd_number *)v_series, (zd_number *)0, (zd_number *)scratch);
}

static int precise_residuals(const double *numbers, const double *t, const double *p, const double *v, double *Phi, double *Psi,
                             double *M, double *C, double *A)
{
    return residuals((const zd_number *)numbers, *(const zd_number *)t, (const zd_number *)p, (const zd_number *)v,
                     (zd_number *)Phi, (zd_number *)Psi, M, C, A);
}
""".splitlines()


def function(writer: Any) -> list[str]:
    """The function of Phi (3), of Psi = C v + Phi_t (5), and of the matrices, rounded; entries that are zero are not written."""
    lines = ["(void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;", *writer.values()]
    lines += [f"Phi[{i}] = z{number};" for i, number in enumerate(writer.terms.get("Phi", ()))]
    for k in range(writer.m):
        lines.append(f"Psi[{k}] = {_velocity_residual(writer, k)};")
    for name in ("M", "C", "A"):
        numbers = [writer.entry(name, place) for place in range(len(writer.terms.get(name, ())))]
        lines += [f"{name}[{place}] = z{number}.high;" for place, number in enumerate(numbers) if number is not None]
    return [*SIGNATURE, "{", *indented(used([*lines, "return ZD_DONE;"])), "}", ""]


def used(lines: list[str]) -> list[str]:
    """Statements without those that define a value that no other reads."""
    uses = Counter(name for line in lines for name in NAME.findall(line))
    kept = []
    for line in reversed(lines):
        defined = DEFINITION.match(line.lstrip())
        if defined and uses[defined[1]] == 1:
            uses.subtract(NAME.findall(line))
        else:
            kept.append(line)
    return kept[::-1]


def _velocity_residual(writer: Any, k: int) -> str:
    value = writer.value_of("Phi_t", k)
    for j in range(writer.nv):
        entry = writer.entry("C", k * writer.nv + j)
        if entry is not None:
            value = f"ZD_ADD({value}, ZD_MUL(z{entry}, v[{j}]))"
    return value
