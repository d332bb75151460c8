"""Advice about what is damaged or missing: the commands that `mmweaver verify` prints are run."""

import re
import shlex
import shutil
from pathlib import Path

from mmweaver.cli.main import main
from tests.advice.harness import Row, Step, Try, Words, edit, instead, printed, repaired

ONE = "generate --demo --text 'a person waves' --frames 1 --no-pictures --quiet"
BATCH = "generate --demo --texts texts.txt --frames 1 --no-pictures --quiet --out out"
VIEW = "view out -o page.html --no-browser"


def made_again(command: str) -> Try:
    """The command that made it, which the message names in words, and `verify` again."""

    def changed(words: Words, message: str) -> list[Step]:
        assert re.search("as it was made|the command that (made|wrote) .*--overwrite", message), message
        return [shlex.split(command), words]

    return changed


def run(command: str) -> None:
    assert main(shlex.split(command)) == 0


def _generated() -> None:
    run(f"{ONE} --out out")


def _damaged(name: str, content: bytes = b"no more what it was") -> None:
    _generated()
    Path("out", name).write_bytes(content)


def _cut_short(name: str) -> None:
    _generated()
    Path("out", name).write_bytes(Path("out", name).read_bytes()[:-1])


def _rooms() -> None:
    shutil.rmtree("out", ignore_errors=True)
    run("rooms out --layouts 1 --kinds office --quiet")
    (file,) = Path("out").glob("*/depth.png")
    file.write_bytes(b"none")


def _texts() -> None:
    Path("texts.txt").write_text("a person waves\na person stands\n")
    run(BATCH)


def _list_damaged() -> None:
    _texts()
    Path("out/sequences.json").write_text("{}")


def _packed() -> None:
    _generated()
    run("compress out/radar.npz -o walk.mmw --quality 30 --quiet")
    content = bytearray(Path("walk.mmw").read_bytes())
    content[len(content) // 2] ^= 255
    Path("walk.mmw").write_bytes(content)


def _request_damaged() -> None:
    _damaged("request.toml")
    Path("out/points.npz").unlink()


ROWS = (
    Row(
        "is damaged; find out what else is with: mmweaver verify",
        VIEW,
        (repaired("mmweaver verify"),),
        before=lambda: _cut_short("SHA256SUMS"),
    ),
    Row(
        "; make it anew (mmweaver verify",
        VIEW,
        (repaired("says how"), edit("or delete", lambda: Path("out/SHA256SUMS").unlink())),
        before=lambda: _cut_short("radar.json"),
    ),
    Row(
        "mmweaver □ --config □ --out □ --overwrite",
        "verify out",
        (printed("make it anew with: "),),
        before=lambda: _damaged("radar.npz"),
    ),
    Row(
        "the command that made □, with --overwrite",
        "verify out",
        (made_again(f"{ONE} --out out --overwrite"),),
        before=_request_damaged,
    ),
    Row(
        "mmweaver rooms NEW_FOLDER --config",
        "verify out",
        (printed("make it anew with: ", ["verify", "NEW_FOLDER"]),),
        before=_rooms,
    ),
    Row(
        "mmweaver generate --texts ... --out □, as it was made",
        "verify out",
        (made_again(BATCH),),
        before=_list_damaged,
    ),
    Row(
        "the command that wrote □, with --overwrite",
        "verify walk.mmw",
        (made_again("compress out/radar.npz -o walk.mmw --quality 30 --overwrite"),),
        before=_packed,
    ),
    Row(
        "does not exist; give a file or folder that mmweaver wrote",
        "verify absent",
        (instead("give a file or folder", "absent", "{walk}"),),
    ),
)
