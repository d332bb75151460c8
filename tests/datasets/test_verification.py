"""mmweaver verify as a whole: what is damaged in each kind of thing that mmweaver writes, and what makes it anew."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.atomic_files import staged_folder
from mmweaver.core.errors import InputError
from mmweaver.core.staging import staging_path
from mmweaver.core.tensor_files import write_tensors
from mmweaver.datasets.verification import verify


def flip(file: Path, at: int = -1) -> None:
    data = bytearray(file.read_bytes())
    data[at] ^= 4
    file.write_bytes(bytes(data))


@pytest.fixture
def results(tmp_path: Path) -> Path:
    with staged_folder(tmp_path / "set" / "0000") as stage:
        (stage / "radar.npz").write_text("cube")
        (stage / "request.toml").write_text('command = "generate"\nseed = 3\n')
    return tmp_path / "set" / "0000"


def test_a_result_folder(results: Path):
    assert verify(results).is_sound
    assert verify(results / "radar.npz").is_sound
    flip(results / "radar.npz")
    for path in (results, results / "radar.npz"):
        found = verify(path)
        assert [str(one) for one in found.damaged] == [f"{results / 'radar.npz'} is not as it was written"]
        assert found.commands == [f"mmweaver generate --config {results}/request.toml --out {results} --overwrite"]
    (results / "radar.npz").unlink()
    assert verify(results).damaged[0].what == "is missing"


@pytest.fixture
def labelled(tmp_path: Path) -> Path:
    folder = tmp_path / "labelled"
    with staged_folder(folder) as stage:
        (stage / "sequences.zarr" / "iq").mkdir(parents=True)
        (stage / "sequences.zarr" / "iq" / "0").write_text("signal")
        (stage / "set.json").write_text('{"command": "mmweaver dataset labelled --activities mine.toml"}')
    return folder


def test_a_labelled_set(labelled: Path):
    found = verify(labelled)
    assert (found.kind, found.is_sound, found.checked) == ("labelled set", True, 2)
    flip(labelled / "sequences.zarr" / "iq" / "0")
    found = verify(labelled)
    assert [one.file.name for one in found.damaged] == ["0"]
    made_by = "mmweaver dataset labelled --activities mine.toml"
    assert found.commands == [f"rm -r {labelled / 'sequences.zarr'}, then {made_by}"]
    shutil.rmtree(labelled / "sequences.zarr")  # as where it was interrupted
    assert verify(labelled).commands == [made_by]


@pytest.mark.parametrize("name", ["set.json", "SHA256SUMS"])
def test_a_labelled_set_without_a_file_of_its_own(labelled: Path, name: str):
    (labelled / name).unlink()
    found = verify(labelled)
    assert [(one.file.name, one.what) for one in found.damaged] == [(name, "is missing")]
    assert found.commands[0].startswith("rm -r ")


def test_many_sequences(results: Path):
    folder = results.parent
    (folder / "sequences.json").write_text('{"sequences": [{"folder": "0000"}, {"folder": "0001"}]}')
    found = verify(folder)
    assert [one.file.name for one in found.damaged] == ["0001"]
    (folder / "sequences.json").write_text('{"sequences": [{"folder": "0000"}]')
    assert [one.file.name for one in verify(folder).damaged] == ["sequences.json"]


@pytest.fixture
def stream(tmp_path: Path) -> Path:
    folder = tmp_path / "stream"
    for name in ("00000000", "00000020"):
        with staged_folder(folder / "parts" / name) as stage:
            (stage / "radar.npz").write_text("cube")
    (folder / "parts.jsonl").write_text('{"first_frame": 0, "frames": 20}\n{"first_frame": 20, "frames": 1}\n{"fi')
    return folder


def test_a_stream(stream: Path):
    found = verify(stream)
    assert (found.kind, found.checked, found.is_sound) == ("stream", 2, True)
    assert found.unchecked == [str(stream)]  # it was not finished
    flip(stream / "parts" / "00000000" / "radar.npz")
    shutil.rmtree(stream / "parts" / "00000020")
    assert [one.what for one in verify(stream).damaged] == ["is not as it was written", "is missing"]


def test_files_with_checksums_of_their_own(tmp_path: Path):
    file = tmp_path / "points.npz"
    np.savez(file, x=np.arange(100))
    assert verify(file).is_sound
    flip(file, 200)
    found = verify(file)
    assert [one.what for one in found.damaged] == ["is not as it was written"]
    assert found.commands == [f"the command that wrote {file}, with --overwrite"]


def test_a_data_set(tiny_signals: Path, tmp_path: Path):
    assert verify(tiny_signals).is_sound
    data = tmp_path / "set"
    shutil.copytree(tiny_signals, data)
    flip(data / "office_000" / "iq" / "c" / "0" / "0" / "0" / "0" / "0" / "0", 100)
    shutil.rmtree(data / "dining_room_000")
    (data / "radar.json").unlink()
    found = verify(data)
    assert sorted(one.what for one in found.damaged) == ["is missing", "is missing", "is not as it was written"]
    assert found.commands[0].startswith("mmweaver dataset")
    assert "--radar awr1843" in found.commands[0]
    assert found.commands[0].endswith("--repair")
    (data / "plan.json").unlink()
    assert "--repair" in verify(data).commands[0]


def test_a_training_run(tmp_path: Path):
    write_tensors(tmp_path / "best.safetensors", {"a": torch.ones(9)})
    torch.save({"a": torch.ones(100)}, tmp_path / "checkpoint.pt")
    assert verify(tmp_path).is_sound
    assert verify(tmp_path / "best.safetensors").is_sound
    staging_path(tmp_path / "best.safetensors").write_bytes(b"cut short by a kill")
    assert verify(tmp_path).is_sound
    flip(tmp_path / "best.safetensors")
    flip(tmp_path / "checkpoint.pt", (tmp_path / "checkpoint.pt").stat().st_size // 2)
    assert len(verify(tmp_path).damaged) >= 1


def test_what_cannot_be_verified(tmp_path: Path):
    (tmp_path / "a.png").write_text("a")
    for path in (tmp_path, tmp_path / "a.png", tmp_path / "nothing"):
        with pytest.raises(InputError):
            verify(path)
