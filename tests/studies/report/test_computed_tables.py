"""Tables that need more than a declaration, of small results."""

import json
from pathlib import Path
from typing import Any

import pytest

from mmweaver.core.errors import InputError
from studies.report.computed_tables import ablation_table, codec_margins_table, codecs_table


def put(folder: Path, name: str, rows: list[dict[str, Any]], **more: Any) -> None:
    file = folder / f"{name}.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"method": file.stem, "rows": rows, **more}))


def test_an_ablation_shows_differences_of_pairs(tmp_path: Path):
    for name, each in (("whole", [0.2, 0.8]), ("no_ghosts", [0.1, 0.7]), ("realization", [0.9, 0.9])):
        metrics = {"ra_ssim": {"value": sum(each) / 2, "each": each}}
        put(tmp_path, f"ablation/{name}", [{"method": name.replace("_", " "), "metrics": metrics}])
    lines = ablation_table(tmp_path).splitlines()
    assert [line.split("|")[1].strip() for line in lines[2:]] == ["whole", "no ghosts", "realization"]
    assert lines[2].startswith("| whole | 0.50 |")
    assert "0.40 (-0.100; -0.100 to -0.100)" in lines[3]  # rooms differ, their differences do not


def test_an_ablation_needs_the_whole_network(tmp_path: Path):
    put(tmp_path, "ablation/no_ghosts", [{"method": "no ghosts", "metrics": {}}])
    with pytest.raises(InputError, match="whole"):
        ablation_table(tmp_path)


def test_the_best_codec_is_bold_and_margins_are_to_the_best_baseline(tmp_path: Path):
    """What was measured on another cube than ours is left out."""
    for codec, error, cube in (("mmw", -10.0, "a"), ("zfp", -8.0, "a"), ("svd", -9.0, "a"), ("cp", -20.0, "b")):
        metrics = {name: {"value": error} for name in ("nmse_active_db", "nmse_db")} | {
            "nmse_moving_db": {"value": None}
        }
        put(tmp_path, f"codecs/{codec}", [{"dataset": {"name": "walk", "sha256": cube}, "metrics": metrics,
             "size": {"bytes_allowed": allowed, "bytes": 2490}} for allowed in (2500, 5000)])  # fmt: skip
    assert "| walk | mmw | **-10.0** / - | **-10.0** / - |" in codecs_table(tmp_path)
    assert "| walk | cp | - / - | - / - |" in codecs_table(tmp_path)
    # the larger file is exact in half of its bytes
    assert codec_margins_table(tmp_path).endswith("| walk | 1.00 / - / 1.00 | 1.00 / - / 1.00 † |")
