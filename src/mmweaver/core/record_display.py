"""Display of records: sizes and spans instead of arrays, as one line or as a table in a notebook."""

import html


class ShownByFacts:
    """Base of records whose repr shows a few facts instead of all values."""

    def facts(self) -> dict[str, str]:
        """Short facts by name, such as sizes and spans."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}: {value}' for name, value in self.facts().items())})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in self.facts().items()
        )
        return f"<table><caption>{html.escape(type(self).__name__)}</caption>{rows}</table>"


def span(values: object, unit: str, decimals: int = 2) -> str:
    """Formats length, first and last value of an axis.

    Args:
        values: Values of the axis, (n,).
        unit: Unit that is appended.
        decimals: Number of decimals. Default: 2.

    Returns:
        Text such as "3, 0.70 to 3.48 m".

    >>> import numpy as np
    >>> span(np.array([0.7, 1.0, 3.48]), "m")
    '3, 0.70 to 3.48 m'
    >>> span(np.zeros(0), "m")
    '0'
    """
    import numpy as np

    axis = np.asarray(values)
    return f"{len(axis)}, {axis[0]:.{decimals}f} to {axis[-1]:.{decimals}f} {unit}" if len(axis) else "0"
