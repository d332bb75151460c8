"""What cannot be written is noticed before any work."""

import os
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import check_output_file, check_output_folder


def test_an_input_is_never_replaced(tmp_path: Path):
    recording = tmp_path / "radar.npz"
    recording.write_text("")
    (tmp_path / "link.npz").symlink_to("radar.npz")
    for out, given in ((recording, recording), (tmp_path / "link.npz", recording), (recording, tmp_path)):
        with pytest.raises(InputError, match=r"radar\.npz"):
            check_output_file(out, overwrite=True, inputs=[None, given])
    with pytest.raises(InputError, match=r"radar\.npz.*--out"):
        check_output_folder(tmp_path, overwrite=True, files=("radar.npz",), inputs=[recording])
    check_output_file(tmp_path / "small.mmw", overwrite=True, inputs=[tmp_path])
    check_output_folder(tmp_path, overwrite=True, files=("points.npz",), inputs=[recording])


def test_a_folder_where_a_file_must_be_and_the_other_way_round(tmp_path: Path):
    (tmp_path / "sequences.json").mkdir()
    (tmp_path / "file").write_text("")
    (tmp_path / "nowhere").symlink_to("nowhere")
    with pytest.raises(InputError, match="is a folder"):
        check_output_folder(tmp_path, overwrite=True, files=("sequences.json",))
    with pytest.raises(InputError, match="is a folder"):
        check_output_file(tmp_path / "sequences.json", overwrite=True)
    for out in ("file", "file/out"):
        with pytest.raises(InputError, match="not a folder"):
            check_output_folder(tmp_path / out, overwrite=True)
    with pytest.raises(InputError, match="leads nowhere"):
        check_output_folder(tmp_path / "nowhere", overwrite=True)
    with pytest.raises(InputError, match="neither a file"):
        check_output_file(Path("/dev/null"), overwrite=True)


def test_names_that_are_too_long_and_folders_without_permission(tmp_path: Path):
    for out in (tmp_path / ("a" * 300), tmp_path / "new" / ("a" * 300), tmp_path / ("a/" * 3000)):
        with pytest.raises(InputError, match="shorter name") as caught:
            check_output_folder(out, overwrite=False)
        assert len(str(caught.value)) < 500
        with pytest.raises(InputError, match="shorter name"):
            check_output_file(out, overwrite=False)
    if os.geteuid() == 0:
        return  # nothing is forbidden
    tmp_path.chmod(0o500)
    with pytest.raises(InputError, match="permission"):
        check_output_folder(tmp_path / "out", overwrite=False)
    tmp_path.chmod(0o700)


def test_nothing_is_left_by_the_checks(tmp_path: Path):
    check_output_folder(tmp_path / "a" / "b", overwrite=False)
    check_output_file(tmp_path / "a" / "b.npz", overwrite=False)
    assert list(tmp_path.iterdir()) == []
