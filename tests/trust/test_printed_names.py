"""Bytes that are no text, and names that would move the cursor: refused at the entry, never raw on a terminal."""

import json
import os
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest

from mmweaver.cli.main import main

ESCAPE = "\x1b[2J\x9b31m\u202e"
IS_LINUX = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="names of files are text here")


def is_clean(text: str) -> bool:
    return all(one in "\n\t" or unicodedata.category(one) not in ("Cc", "Cs") for one in text) and "\u202e" not in text


def run(argv: list[bytes | str], cwd: Path | str) -> subprocess.CompletedProcess[bytes]:
    """In a process of its own, whose words may be any bytes."""
    command = [os.fsencode(sys.executable), b"-m", b"mmweaver", *(os.fsencode(word) for word in argv)]
    return subprocess.run(command, cwd=cwd, capture_output=True, check=False)


@IS_LINUX
@pytest.mark.parametrize(
    "argv",
    [
        ["motion", b"a person waves \xff\xfe", "--out", "m.npz"],
        ["generate", "--demo", "--text", "a person waves", "--out", b"caf\xe9"],
        ["radar", b"\xff.cfg"],
        ["--json", b"\xc3\x28"],
    ],
)
def test_words_that_are_no_text_are_refused_before_any_work(argv: list[bytes | str], tmp_path: Path):
    ended = run(argv, tmp_path)
    assert ended.returncode == 2
    lines = ended.stderr.decode().splitlines()
    assert len(lines) == 1
    assert "no UTF-8 text" in lines[0]
    assert list(tmp_path.iterdir()) == []


@IS_LINUX
def test_a_working_directory_that_is_gone_is_one_line(tmp_path: Path):
    gone = tmp_path / "gone"
    gone.mkdir()
    code = f"import os, sys; os.chdir({str(gone)!r}); os.rmdir({str(gone)!r});"
    code += "from mmweaver.cli.main import main; sys.exit(main(['radar', 'awr1843']))"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert ended.stderr == "mmweaver: error: the working directory was removed; change into another one\n"


@IS_LINUX
@pytest.mark.parametrize("argv", [
    ["motion", "a person waves", "--out", f"{ESCAPE}.npz"], ["sample", f"a\n{ESCAPE}"], ["info", f"{ESCAPE}.mmw"],
    ["verify", f"{ESCAPE}"], ["radar", f"{ESCAPE}.cfg"],
    ["compress", f"{ESCAPE}.bin", "-o", "a.mmw", "--bytes", "9999"],
    ["process", f"{ESCAPE}.bin", "--radar", "awr1843", "--out", f"{ESCAPE}"], ["view", f"{ESCAPE}"],
    ["export", f"{ESCAPE}", "--to", "mat", "--out", f"{ESCAPE}"], ["plot", f"{ESCAPE}", "-o", f"{ESCAPE}.png"],
    ["motion", f"a person waves {ESCAPE}", "--json"], ["motion", f"a person waves {ESCAPE}"],
    ["generate", "--demo", "--texts", f"{ESCAPE}.txt", "--out", "out"],
    ["dataset", f"{ESCAPE}", "--rooms", f"{ESCAPE}"],
    ["decompress", f"{ESCAPE}.mmw", "-o", f"{ESCAPE}.npz"], ["points", f"{ESCAPE}.dat", "-o", f"{ESCAPE}.npz"],
    [f"{ESCAPE}"], ["generate", f"--{ESCAPE}"],
])  # fmt: skip
def test_no_control_character_reaches_the_terminal(
    argv: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    """In names that are given, whether or not they are there."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / f"{ESCAPE}.cfg").write_text(f"{ESCAPE} 1 2\n")
    (tmp_path / f"{ESCAPE}.txt").write_text(f"{ESCAPE}\n")
    main(argv)
    printed = capsys.readouterr()
    assert is_clean(printed.out), repr(printed.out)
    assert is_clean(printed.err), repr(printed.err)
    assert printed.err.count("\n") <= 1


@IS_LINUX
def test_names_inside_of_folders_are_printed_without_control_characters(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    assert main(["sample", str(tmp_path / "s"), "--quiet"]) == 0
    sums = tmp_path / "s" / "SHA256SUMS"
    sums.write_text(sums.read_text() + f"{'0' * 64}  {ESCAPE}\r.txt\n")
    assert main(["verify", str(tmp_path / "s")]) == 1
    printed = capsys.readouterr()
    assert is_clean(printed.out + printed.err), repr(printed.out)
    main(["verify", str(tmp_path / "s"), "--json"])
    assert len(json.loads(capsys.readouterr().out)["damaged"]) == 1


@IS_LINUX
def test_what_is_kept_is_named_without_control_characters(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """The message of Ctrl-C."""
    code = "import signal, sys; from pathlib import Path; from mmweaver.cli import main as cli, radar;"
    code += "from mmweaver.core.atomic_files import atomic_file\n"
    code += (
        "def run(asked):\n    with atomic_file(Path(sys.argv[1])) as t: t.write_text('')\n    raise KeyboardInterrupt\n"
    )
    code += "radar.run = run; sys.exit(cli.main(['radar', 'awr1843']))"
    name = str(tmp_path / f"{ESCAPE}.txt")
    ended = subprocess.run([sys.executable, "-c", code, name], capture_output=True, text=True, check=False)
    assert ended.returncode == 130
    assert "finished and kept" in ended.stderr
    assert is_clean(ended.stderr), repr(ended.stderr)
    assert ended.stderr.count("\n") == 1


def test_a_summary_keeps_its_values_as_json(capsys: pytest.CaptureFixture[str]):
    assert main(["motion", "a person waves \u200b\x9b", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["text"] == "a person waves \u200b\x9b"


def test_a_terminal_without_unicode_is_no_traceback(tmp_path: Path):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0", "LC_ALL": "C"}
    command = [sys.executable, "-m", "mmweaver", "motion", "eine Person winkt é"]
    ended = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=tmp_path, check=False)
    assert "Traceback" not in ended.stderr
    assert ended.returncode in (0, 2)
