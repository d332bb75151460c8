"""The wheel holds all that git has below src/mmweaver but for what is named here, no study, and at most 17.6 MB."""

import re
import zipfile

from tests.artifact.artifact import Installed, source_files

LARGEST_BYTES = 17_600_000
NOT_SHIPPED = {"mmweaver/weights/weaver_log.jsonl"}  # the log of a training


def names_in(installed: Installed) -> set[str]:
    """Files in a wheel but for its own records."""
    with zipfile.ZipFile(installed.wheel) as archive:
        return {name for name in archive.namelist() if ".dist-info/" not in name}


def expected_names() -> set[str]:
    """What should lie in a wheel."""
    return {name.removeprefix("src/") for name in source_files("src/mmweaver")} - NOT_SHIPPED


def test_the_wheel_holds_every_file_of_the_package(installed: Installed):
    found, expected = names_in(installed), expected_names()
    assert found == expected, f"missing: {sorted(expected - found)}; not in git: {sorted(found - expected)}"
    assert {"mmweaver/py.typed", "mmweaver/weights/weaver.safetensors", "mmweaver/sample/rgb.webp"} <= found


def test_what_is_not_shipped_is_there():
    assert {f"src/{name}" for name in NOT_SHIPPED} <= set(source_files("src/mmweaver"))


def test_the_wheel_is_small_enough(installed: Installed):
    assert installed.wheel.stat().st_size < LARGEST_BYTES


def test_the_package_imports_no_study(installed: Installed):
    for name in names_in(installed):
        if name.endswith(".py"):
            text = (installed.site / name).read_text(encoding="utf-8")
            assert not re.search(r"^\s*(from|import) studies\b", text, re.MULTILINE), name
