"""Formulas of the furniture's records: arithmetic of sizes, and nothing that a program could do."""

import pytest

from mmweaver.scene.procedural.furniture import evaluate

SIZES = {"width": 1.3, "count": 3, "is_solid": True}


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("-width / 2 + 0.03", -1.3 / 2 + 0.03),
        ("0.1 + 0.2 - 0.3", 0.1 + 0.2 - 0.3),  # from left to right, to the bit
        ("2 * (width - 0.36) / count", 2 * (1.3 - 0.36) / 3),
        ("max(width, count, 2) - min(width, 1)", 2),
        ("1 - is_solid", 0),
        (("-width", 0.5), (-1.3, 0.5)),
        (0.7, 0.7),
    ],
)
def test_a_formula_is_arithmetic(formula: object, value: object):
    assert evaluate(formula, SIZES) == value


@pytest.mark.parametrize(
    "formula",
    [
        *["__import__('os').getcwd()", "width.real"],
        "width ** 2",
        "(lambda: 1)()",
        "max(*[1, 2])",
        *["'wood'", "height"],
        "width / 0",
        "",
    ],
)
def test_anything_else_has_no_value(formula: str):
    with pytest.raises(ValueError, match="no value for") as raised:
        evaluate(formula, SIZES)
    assert "width" in str(raised.value)
