"""What cannot be written is noticed before any work."""

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
