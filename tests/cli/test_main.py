"""The command as a whole: help, version, exit statuses, one line for every error."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from mmweaver import __version__
from mmweaver.cli import radar
from mmweaver.cli.main import main
from tests.platforms import posix_only


def test_help_loads_nothing_heavy():
    code = "import sys; sys.argv = ['mmweaver', '--help']; from mmweaver.cli.main import main\ntry: main()\nfinally: sys.stderr.write(' '.join(m for m in ('numpy', 'matplotlib', 'scipy', 'torch') if m in sys.modules))"  # noqa: E501
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "examples:" in done.stdout
    assert done.stderr == ""
    assert done.returncode == 0


def test_version_and_help_end_well(capsys: pytest.CaptureFixture[str]):
    for argv, word in (
        (["--version"], __version__),
        (["generate", "--help"], "--text"),
        (["process", "--help"], "--layout"),
    ):
        with pytest.raises(SystemExit) as ended:
            main(argv)
        assert ended.value.code == 0
        assert word in capsys.readouterr().out


def test_no_command_shows_the_help(capsys: pytest.CaptureFixture[str]):
    assert main([]) == 2
    assert "generate" in capsys.readouterr().out


INTERRUPTED_IMPORT = """
import sys
class Stop:
    def find_spec(self, name, *_):
        if name == "mmweaver.cli.generate":
            raise KeyboardInterrupt
sys.meta_path.insert(0, Stop())
sys.argv = ["mmweaver", "generate", "--demo"]
from mmweaver.cli.main import main
sys.exit(main())
"""
INTERRUPTED_PYTORCH = """
import signal, sys, time, types
from mmweaver.cli import main
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run in the background
torch = sys.modules["torch"] = types.ModuleType("torch")
torch.__spec__ = types.SimpleNamespace(_initializing=True)
main._stop_cleanly()
signal.raise_signal(signal.SIGINT)
torch.__spec__._initializing = False
try:
    time.sleep(5)
except KeyboardInterrupt:
    sys.exit(130)
"""


@pytest.mark.parametrize(
    ("code", "says"),
    [(INTERRUPTED_IMPORT, "mmweaver: error: interrupted; nothing was written\n"), (INTERRUPTED_PYTORCH, "")],
    ids=["while commands are imported", "while PyTorch starts, which an exception would abort"],
)
def test_an_interruption_of_the_start_is_quiet(code: str, says: str):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, says)


@pytest.mark.parametrize(
    ("raised", "status", "word"),
    [
        (KeyboardInterrupt(), 130, "interrupted; nothing was written"),
        (KeyboardInterrupt("3 of 4 are kept"), 130, "interrupted; 3 of 4 are kept"),
        (MemoryError(), 2, "memory"),
        (OSError(28, "No space left on device", "x/y"), 2, "x/y: No space left"),
    ],
)
def test_what_the_machine_does_to_us_is_one_line(
    raised: BaseException, status: int, word: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def fail(_: object) -> int:
        raise raised

    monkeypatch.setattr(radar, "run", fail)
    assert main(["radar", "awr1843"]) == status
    captured = capsys.readouterr()
    assert word in captured.err
    assert captured.err.count("\n") == 1


def test_a_bug_is_not_hidden(monkeypatch: pytest.MonkeyPatch):
    def fail(_: object) -> int:
        raise ZeroDivisionError

    monkeypatch.setattr(radar, "run", fail)
    with pytest.raises(ZeroDivisionError):
        main(["radar", "awr1843"])


def test_a_reader_that_leaves_is_no_error():
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "mmweaver", "radar", "awr1843"], stdout=writing, stderr=subprocess.PIPE, check=False
    )
    os.close(writing)
    assert done.returncode == 141
    assert done.stderr == b""


def test_rare_options_are_in_the_full_help_alone(capsys: pytest.CaptureFixture[str]):
    texts = []
    for option in ("--help", "--help-all", "--help"):
        with pytest.raises(SystemExit) as ended:
            main(["generate", option])
        assert ended.value.code == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[2]
    for group in ("input:", "motion:", "radar:", "output:", "advanced:"):
        assert f"\n{group}\n" in texts[0]
    assert "--classes" not in texts[0]
    assert "mmweaver generate --help-all" in texts[0]
    assert "--classes" in texts[1]
    with pytest.raises(SystemExit):
        main(["radar", "--help"])
    assert "\n1 more option: " in capsys.readouterr().out


STOPPED = """
import sys, time
from pathlib import Path
from mmweaver.cli import main
from mmweaver.core.atomic_files import staged_folder

def write(argv):
    with staged_folder(Path(sys.argv[1])) as stage:
        (stage / "half.txt").write_text("half")
        print("ready", flush=True)
        time.sleep(30)

main._run = write  # a command that takes its time
sys.exit(main.main())
"""


@posix_only
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_signal_that_ends_a_command_leaves_nothing_over(name: str, tmp_path: Path):
    """docs/security.md: on an error, Ctrl-C or SIGTERM the command removes its temporary files."""
    reset = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
    words = [sys.executable, "-c", reset + STOPPED, str(tmp_path / "new" / "out")]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    assert list(tmp_path.rglob("half.txt"))
    process.send_signal(getattr(signal, name))
    _, said = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "interrupted" in said
    assert said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
