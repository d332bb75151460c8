"""Every file of data or weights has an entry in a LICENSE.txt that lies next to it, in the wheel and the repository."""

import re
from pathlib import Path

import pytest

from mmweaver.core.safe_files.safe_tensors import read_tensor_metadata
from mmweaver.models.weights import FORMAT, read_card

ROOT = Path(__file__).resolve().parents[2]
# what is not written by hand; texts and code are under LICENSE
KINDS = {".safetensors", ".npz", ".npy", ".json", ".jsonl", ".png", ".webp", ".jpg", ".zip", ".bin", ".cfg", ".ply"}
PLACES = (ROOT / "src" / "mmweaver", ROOT / "weights")
DATA = [path for place in PLACES for path in sorted(place.rglob("*")) if path.suffix in KINDS]


def _entries(file: Path) -> dict[str, str]:
    """{name of a file: text of its entry} of a LICENSE.txt."""
    found = re.findall(r"^(\S[^\n]*)\n((?: {4}.*\n)+)", file.read_text(encoding="utf-8"), re.MULTILINE)
    return {name: text for names, text in found for name in names.split(", ")}


def _entry_of(path: Path) -> str:
    for folder in path.parents:
        file = folder / "LICENSE.txt"
        if file.is_file():
            return _entries(file).get(path.relative_to(folder).as_posix(), "")
    return ""


@pytest.mark.parametrize("path", DATA, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_file_of_data_or_weights_has_its_licence_and_source_next_to_it(path: Path):
    entry = _entry_of(path)
    assert re.search(r"^    (made by|trained on): \w", entry, re.MULTILINE), f"{path.name}: where is it from?"
    licence = re.search(r"^    licence: (.+)$", entry, re.MULTILINE)
    assert licence, f"{path.name} has no licence"
    if path.suffix == ".safetensors" and read_tensor_metadata(path).get("format") == FORMAT:
        assert read_card(path).licence == licence[1]


@pytest.mark.parametrize("file", [file for place in PLACES for file in sorted(place.rglob("LICENSE.txt"))], ids=str)
def test_an_entry_names_files_that_are_there_and_the_text_of_the_licence_follows(file: Path):
    for name, entry in _entries(file).items():
        assert (file.parent / name).is_file(), f"{file} names {name}"
        assert "licence: MIT" not in entry or (ROOT / "LICENSE").read_text() in file.read_text()


def test_data_is_found():
    names = {path.name for path in DATA}
    assert {"weaver.safetensors", "rgb.webp", "trees.npz"} <= names
