"""Checks whether files written by mmweaver are intact, and names the command that regenerates damaged ones.

verify("walk/") -> Verification: a result folder, a folder of --texts, of rooms or of exports, a stream, a data set, a
labelled set of activities, a run of mmweaver train, any file listed in a SHA256SUMS, or one with its own checksums
(.mmw, .mmwl, .npz, .zip, weights)
"""

import contextlib
import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mmweaver.core.checksums import SUMS_FILE, Damage, damage_of_file, read_sums
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import Place
from mmweaver.core.safe_files.safe_arrays import is_sound_zip
from mmweaver.core.safe_files.safe_text import read_json, read_toml
from mmweaver.core.staging import COMMITTED, is_staged
from mmweaver.core.tensor_files import read_tensors
from mmweaver.datasets.activity_store import SET_FILE, STORE
from mmweaver.datasets.dataset_folder import PLAN_FILE, is_done, room_place
from mmweaver.datasets.dataset_plan import check_plan, command_of, room_name, shell_words
from mmweaver.io.stream_folder import LIST, PARTS, is_stream, listed_parts

REQUEST = "request.toml"
BATCH_LIST = "sequences.json"
CHECKPOINT = "checkpoint.pt"
COMMANDS_OF_FOLDERS = ("generate", "process", "rooms")  # valid commands in the request.toml of a result folder


@dataclass
class Verification:
    """Result of a check: what was checked and what is damaged."""

    path: Path
    kind: str
    checked: int = 0  # files
    damaged: list[Damage] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)  # commands that regenerate it
    unchecked: list[str] = field(default_factory=list)  # folders and files without checksums

    @property
    def is_sound(self) -> bool:
        """Whether nothing is damaged."""
        return not self.damaged

    def to_dict(self) -> dict[str, Any]:
        """The result as plain JSON values."""
        return {
            "path": str(self.path),
            "kind": self.kind,
            "files_checked": self.checked,
            "damaged": [{"file": str(one.file), "what": one.what} for one in self.damaged],
            "commands": self.commands,
            "unchecked": self.unchecked,
        }

    def blame(self, damaged: list[Damage], command: str) -> None:
        """Records damage and the command that repairs it.

        Args:
            damaged: Damaged files; may be empty.
            command: Command that regenerates them.
        """
        self.damaged += damaged
        if damaged and command not in self.commands:
            self.commands.append(command)


def verify(path: Path | str) -> Verification:
    """Checks a file or folder against its checksums.

    Args:
        path: File or folder written by mmweaver.

    Returns:
        What was checked and what is damaged.

    Raises:
        InputError: If the path has no checksums.
    """
    path = Path(path)
    if path.is_dir():
        return _verified_folder(path)
    if not path.is_file():
        raise InputError(f"{path} does not exist; give a file or folder that mmweaver wrote")
    if path.suffix == ".safetensors":
        found = Verification(path=path, kind="weights")
        _check_tensors(found, path)
        return found
    sums = read_sums(path.parent)
    if sums is None or path.name not in sums:
        if path.suffix in OWN_CHECKSUMS:
            return _verified_alone(path)
        raise InputError(
            f"{path} has no checksum: {', '.join(OWN_CHECKSUMS)} and .safetensors have their own, and no {SUMS_FILE}"
            " next to it names it"
        )
    found = Verification(path=path, kind="file", checked=1)
    damage = damage_of_file(path.parent, path.name, sums[path.name], use_cache=False)
    found.blame([damage] if damage else [], _command_of_results(path.parent))
    return found


def _verified_folder(folder: Path) -> Verification:
    if (folder / PLAN_FILE).is_file() or _lists(folder, PLAN_FILE):
        return _verified_dataset(folder)
    if (folder / SET_FILE).is_file() or _lists(folder, SET_FILE):
        return _verified_activity_set(folder)
    if any((folder / name).is_file() for name in (CHECKPOINT, "best.safetensors", "weights.safetensors")):
        return _verified_run(folder)
    if is_stream(folder) or _lists(folder, LIST):
        return _verified_stream(folder)
    below = sorted(one for one in folder.iterdir() if one.is_dir() and (one / SUMS_FILE).is_file())
    if (folder / BATCH_LIST).is_file() or (below and not (folder / SUMS_FILE).is_file()):
        return _verified_batch(folder, below)
    if not (folder / SUMS_FILE).is_file():
        raise InputError(
            f"{folder} holds no {SUMS_FILE}, no data set and no training run; nothing here can be verified"
        )
    found = Verification(path=folder, kind="results")
    _check_sums(found, folder, _command_of_results(folder))
    return found


def _verified_dataset(folder: Path) -> Verification:
    found = Verification(path=folder, kind="data set")
    try:
        plan = check_plan(read_json(folder / PLAN_FILE), folder / PLAN_FILE)
        command = command_of(plan, folder)
        names = [room_name(kind, layout) for kind in plan["kinds"] for layout in range(plan["num_layouts"])]
    except (OSError, ValueError, KeyError, TypeError):
        command = f"mmweaver dataset {shlex.quote(str(folder))} --repair, with the options it was made with"
        names = [one.name for one in folder.iterdir() if one.is_dir() and (one / SUMS_FILE).is_file()]
        names += [one.stem for one in folder.glob("[!.]*.zip")]
    _check_sums(found, folder, command)
    for name in sorted(names):
        if is_done(folder, name):
            _check_sums(found, room_place(folder, name), command)
        else:
            found.blame([Damage(file=folder / name, what="is missing")], command)
    return found


def _verified_activity_set(folder: Path) -> Verification:
    found = Verification(path=folder, kind="labelled set")
    place = shlex.quote(str(folder))
    try:
        made_by = shell_words(read_json(folder / SET_FILE)["command"])
    except (OSError, ValueError, KeyError, TypeError):
        made_by = ""
    is_known = made_by.startswith("mmweaver dataset ")
    again = made_by if is_known else f"mmweaver dataset {place} --activities, with the options it was made with"
    if is_known and not (folder / STORE).is_dir():
        found.blame([Damage(file=folder / STORE, what="is missing")], again)  # resumes where it stopped
        return found
    again = f"rm -r {shlex.quote(str(folder / STORE)) if is_known else place}, then {again}"
    if (folder / SUMS_FILE).is_file():
        _check_sums(found, folder, again)
    else:
        found.blame([Damage(file=folder / SUMS_FILE, what="is missing")], again)
    return found


def _verified_batch(folder: Path, below: list[Path]) -> Verification:
    found = Verification(path=folder, kind="sequences")
    listed: list[Path] = []
    if (folder / BATCH_LIST).is_file():
        found.checked += 1
        try:
            entries = read_json(folder / BATCH_LIST)["sequences"]
            listed = [folder / Path(entry["folder"]).name for entry in entries]
            if not all(_is_of(entry, one) for entry, one in zip(entries, listed, strict=True)):
                raise ValueError
        except (OSError, ValueError, KeyError, TypeError):
            again = f"mmweaver generate --texts ... --out {shlex.quote(str(folder))}, as it was made"
            found.blame([Damage(file=folder / BATCH_LIST, what="is not as it was written")], again)
    for one in sorted({*below, *listed}):
        if one.is_dir():
            _check_sums(found, one, _command_of_results(one))
        else:
            again = f"mmweaver generate --texts ... --out {shlex.quote(str(folder))}, as it was made"
            found.blame([Damage(file=one, what="is missing")], again)
    return found


def _is_of(entry: dict[str, Any], folder: Path) -> bool:
    """Whether an entry of the list agrees with the folder's own meta.json."""
    if not (folder / "meta.json").is_file():
        return True
    meta = read_json(folder / "meta.json")
    return all(entry[name] == meta.get(name) for name in ("text", "seed"))


def _verified_run(folder: Path) -> Verification:
    found = Verification(path=folder, kind="training run")
    for file in sorted(folder.glob("*.safetensors")):
        if not is_staged(file.name):
            _check_tensors(found, file)
    checkpoint = folder / CHECKPOINT
    if checkpoint.is_file():
        found.checked += 1
        if not is_sound_zip(checkpoint):
            again = f"rm {shlex.quote(str(checkpoint))}, then {_command_of_run(folder)}"
            found.blame([Damage(file=checkpoint, what="is not as it was written")], again)
    return found


def _check_tensors(found: Verification, file: Path) -> None:
    found.checked += 1
    try:
        _, header = read_tensors(file)
    except InputError:
        found.blame([Damage(file=file, what="is not as it was written")], _command_of_weights(file))
        return
    if "sha256" not in header:
        found.unchecked.append(str(file))


def _verified_stream(folder: Path) -> Verification:
    found = Verification(path=folder, kind="stream")
    again = "make the stream anew in another folder: whole parts that are there stay readable"
    _check_sums(found, folder, again)
    parts = set((folder / PARTS).glob("[0-9]*")) if (folder / PARTS).is_dir() else set()
    with contextlib.suppress(InputError):  # a missing list is detected by the checksums
        parts |= set(listed_parts(folder))
    for part in sorted(parts):
        if part.is_dir():
            _check_sums(found, part, again)
        else:
            found.blame([Damage(file=part, what="is missing")], again)
    return found


def _verified_alone(file: Path) -> Verification:
    """Checks a file with its own checksums: CRC-32 of each chunk of .mmw and .mmwl, or of each entry of a zip."""
    found = Verification(path=file, kind=file.suffix, checked=1)
    if not OWN_CHECKSUMS[file.suffix](file):
        again = f"the command that wrote {shlex.quote(str(file))}, with --overwrite"
        found.blame([Damage(file=file, what="is not as it was written")], again)
    return found


def _is_sound_mmw(file: Path) -> bool:
    from mmweaver.compression.mmw_codec import describe_mmw

    try:
        describe_mmw(file)
    except InputError:
        return False
    return True


def _is_sound_mmwl(file: Path) -> bool:
    from mmweaver.compression.lossless_file import LosslessFile

    try:
        LosslessFile(file).check()
    except InputError:
        return False
    return True


OWN_CHECKSUMS = {".mmw": _is_sound_mmw, ".mmwl": _is_sound_mmwl, ".npz": is_sound_zip, ".zip": is_sound_zip}


def _check_sums(found: Verification, folder: Place, command: str) -> None:
    if (folder / COMMITTED).is_dir():
        found.blame([Damage(file=folder, what="was being replaced when that was interrupted")], command)
    try:
        sums = read_sums(folder)
    except InputError:
        found.blame([Damage(file=folder / SUMS_FILE, what="is not as it was written")], command)
        return
    if sums is None:
        found.unchecked.append(str(folder))
        return
    found.checked += len(sums)
    each = (damage_of_file(folder, name, expected, use_cache=False) for name, expected in sums.items())
    found.blame([one for one in each if one is not None], command)


def _lists(folder: Path, name: str) -> bool:
    try:
        return name in (read_sums(folder) or {})
    except InputError:
        return False


def _command_of_results(folder: Path) -> str:
    """Command that regenerates a result folder, or a folder of rooms."""
    request, place = folder / REQUEST, shlex.quote(str(folder))
    try:
        command = read_toml(request)["command"]
    except (OSError, ValueError, KeyError):
        command = None
    if command not in COMMANDS_OF_FOLDERS:
        return f"the command that made {place}, with --overwrite (its {REQUEST} is missing or damaged)"
    if command == "rooms":
        return f"mmweaver rooms NEW_FOLDER --config {shlex.quote(str(request))}"
    return f"mmweaver {command} --config {shlex.quote(str(request))} --out {place} --overwrite"


def _command_of_run(folder: Path) -> str:
    request = folder / REQUEST
    if request.is_file():
        return f"mmweaver train --config {shlex.quote(str(request))} --out {shlex.quote(str(folder))}"
    return f"the mmweaver train command that made {shlex.quote(str(folder))}"


def _command_of_weights(file: Path) -> str:
    if file.parent.name == "weights" and file.parent.parent.name == "mmweaver":
        return "pip install --force-reinstall mmweaver"
    if file.name == "best.safetensors":  # cannot be restored from the checkpoint, so start over
        return f"rm {shlex.quote(str(file.parent / CHECKPOINT))}, then {_command_of_run(file.parent)}"
    return _command_of_run(file.parent)
