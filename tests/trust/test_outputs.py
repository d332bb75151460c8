"""Files and folders of others next to an output, and two writers of one file."""

import os
import sys
import threading
from pathlib import Path

import pytest

if not sys.platform.startswith("linux"):
    pytest.skip("commands run in forked processes", allow_module_level=True)

from mmweaver.cli.main import main
from mmweaver.compression.mmw_container import MmwFile
from mmweaver.core.atomic_files import (
    append_line,
    atomic_file,
    claimed_folder,
    create_once,
    opened_to_append,
    staged_folder,
)
from mmweaver.core.errors import InputError
from mmweaver.core.locks import locked
from mmweaver.core.output_checks import check_output_file, check_output_folder
from mmweaver.core.staging import staging_path, sweep
from mmweaver.io.npz_files import write_radar_npz
from tests.compression.echoes import SMALL, crowd
from tests.trust.commands_in_children import run_at_once


@pytest.fixture
def theirs(tmp_path: Path) -> Path:
    folder = tmp_path / "theirs"
    folder.mkdir()
    (folder / "thesis.txt").write_text("precious")
    return folder


def test_a_folder_behind_a_link_is_refused(tmp_path: Path, theirs: Path):
    """A result's own folder that a stranger has replaced by a link."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "parts").symlink_to(theirs)
    check_output_folder(out, overwrite=True)
    with pytest.raises(InputError, match="leads out"), atomic_file(out / "parts" / "thesis.txt") as temporary:
        temporary.write_text("mine")
    with pytest.raises(InputError, match="leads out"), staged_folder(out / "parts", overwrite=True):
        pass
    with pytest.raises(InputError, match="leads out"), staged_folder(out / "parts" / "0", keep_existing=True):
        pass
    with pytest.raises(InputError, match="leads out"):
        create_once(out / "parts" / "plan.json", "mine")
    with pytest.raises(InputError, match="leads out"):
        append_line(out / "parts" / "log.jsonl", "mine")
    assert [file.name for file in theirs.iterdir()] == ["thesis.txt"]
    assert (theirs / "thesis.txt").read_text() == "precious"


def test_nothing_is_appended_behind_a_link_or_a_fifo(tmp_path: Path, theirs: Path):
    (tmp_path / "log.jsonl").symlink_to(theirs / "thesis.txt")
    os.mkfifo(tmp_path / "adc_data.bin")
    for name in ("log.jsonl", "adc_data.bin"):
        with pytest.raises(InputError, match=name):
            append_line(tmp_path / name, "mine")
        with pytest.raises(InputError, match=name), opened_to_append(tmp_path / name) as file:
            file.write(b"mine")
    assert (theirs / "thesis.txt").read_text() == "precious"


def test_what_is_created_once_may_be_a_fifo_of_a_stranger(tmp_path: Path):
    os.mkfifo(tmp_path / "plan.json")
    with pytest.raises(InputError, match=r"plan\.json"):
        create_once(tmp_path / "plan.json", "mine")


def test_leftovers_of_other_users_and_links_stay(tmp_path: Path, theirs: Path, monkeypatch: pytest.MonkeyPatch):
    name = staging_path(tmp_path / "a.npz").name.replace(f"-{os.getpid()}-", "-999999999-")
    (tmp_path / name).symlink_to(theirs)
    sweep(tmp_path, again=True)
    assert not os.path.lexists(tmp_path / name)
    assert (theirs / "thesis.txt").is_file()
    (tmp_path / name).write_text("of another user")
    monkeypatch.setattr(os, "geteuid", lambda: 4711)
    sweep(tmp_path, again=True)
    assert (tmp_path / name).is_file()


# two writers ------------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    write_radar_npz(folder / "radar.npz", crowd())
    (folder / "radar.json").write_text(SMALL.to_json())
    return folder


def test_two_appends_keep_both_recordings(tmp_path: Path, recording: Path):
    words = ["compress", str(recording / "radar.npz"), "-o", str(tmp_path / "a.mmw"), "--bytes", "3000", "--quiet"]
    assert main(words) == 0
    held = MmwFile(tmp_path / "a.mmw").num_frames
    for count in (2, 3):
        ended = run_at_once([lambda: main([*words, "--append"])] * count)
        assert [one.status for one in ended] == [0] * count
        held += count * len(crowd().values)
        assert MmwFile(tmp_path / "a.mmw").num_frames == held


def test_the_first_append_of_two_makes_the_file(tmp_path: Path, recording: Path):
    words = ["compress", str(recording / "radar.npz"), "-o", str(tmp_path / "a.mmw"), "--bytes", "3000", "--quiet"]
    ended = run_at_once([lambda: main([*words, "--append"])] * 2)
    done = sum(one.status == 0 for one in ended)
    assert done >= 1
    assert all(one.is_sound for one in ended), ended
    assert MmwFile(tmp_path / "a.mmw").num_frames == done * len(crowd().values)


def test_a_file_that_came_meanwhile_stays(tmp_path: Path):
    target = tmp_path / "a.txt"
    check_output_file(target, overwrite=False)
    with pytest.raises(InputError, match="meanwhile"), atomic_file(target) as temporary:
        temporary.write_text("mine")
        target.write_text("theirs")
    assert target.read_text() == "theirs"


def test_a_folder_that_was_filled_meanwhile_stays(tmp_path: Path):
    out = tmp_path / "out"
    out.mkdir()
    with pytest.raises(InputError, match="not empty"), staged_folder(out) as stage:
        (stage / "a.txt").write_text("mine")
        (out / "a.txt").write_text("theirs")
    assert (out / "a.txt").read_text() == "theirs"
    assert [file.name for file in out.iterdir()] == ["a.txt"]


def _claim(out: Path) -> int:
    try:
        with claimed_folder(out):
            pass
    except InputError:
        return 2
    return 0


def test_a_second_command_is_refused_where_one_writes_part_by_part(tmp_path: Path):
    out = tmp_path / "new" / "out"
    with claimed_folder(out):
        (ended,) = run_at_once([lambda: _claim_in_new_process(out)])
        assert ended.status == 2
        (out / "a.txt").write_text("")
    assert _claim(out) == 0
    with pytest.raises(RuntimeError), claimed_folder(tmp_path / "b" / "c"):
        raise RuntimeError
    assert not (tmp_path / "b").exists()


def _claim_in_new_process(out: Path) -> int:
    """A forked child holds what its parent holds; a new process does not."""
    import subprocess

    code = "import sys; from pathlib import Path; from mmweaver.core.atomic_files import claimed_folder;"
    code += "from mmweaver.core.errors import InputError\ntry:\n    with claimed_folder(Path(sys.argv[1])): pass\n"
    code += "except InputError as error:\n    sys.exit(2 * ('another mmweaver command' in str(error)))\n"
    return subprocess.run([sys.executable, "-c", code, str(out)], check=False).returncode


def test_a_lock_waits_for_another_process_and_ends_with_it(tmp_path: Path):
    import subprocess

    code = "import sys, time; from pathlib import Path; from mmweaver.core.locks import locked\n"
    code += "with locked(Path(sys.argv[1])):\n    print('held', flush=True)\n    time.sleep(30)\n"
    holder = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    with pytest.raises(InputError, match="another mmweaver command"), locked(tmp_path, wait_s=0.2):
        pass
    threading.Timer(0.3, holder.kill).start()
    with locked(tmp_path, wait_s=20.0), locked(tmp_path, wait_s=0.0):
        pass
    holder.wait()


def test_a_full_disk_names_what_was_to_be_written(tmp_path: Path, recording: Path, monkeypatch: pytest.MonkeyPatch):
    """Not the unfinished file, and not numpy's count of bytes."""
    from mmweaver.core.output_checks import cannot_write

    stage = staging_path(tmp_path / "walk")
    inner = staging_path(stage / "adc_data.bin")
    message = str(cannot_write(inner, OSError(28, os.strerror(28))))
    assert message.startswith(f"cannot write {tmp_path / 'walk' / 'adc_data.bin'}: No space left on device; free some")


def test_samples_that_do_not_fit_say_why(tmp_path: Path):
    from mmweaver.core.boards import PRESETS
    from mmweaver.io.dca1000 import write_bin
    from tests.captures import counts

    (tmp_path / "radar.json").write_text(PRESETS["awr1843"].to_json())

    def write() -> int:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, resource.RLIM_INFINITY))
        try:
            write_bin(tmp_path / "a.bin", counts(PRESETS["awr1843"], 1), counts_per_unit=1.0)
        except InputError as error:
            return int("File too large" in str(error) and "requested" not in str(error))
        return 2

    (ended,) = run_at_once([write])
    assert ended.status == 1
