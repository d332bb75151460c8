"""What the command line does not pay for."""

import subprocess
import sys

from mmweaver.core.boards import PRESETS
from mmweaver.io.dca1000 import bytes_of_frame


def test_the_command_line_starts_without_torch():
    code = "import sys, mmweaver.cli.main, mmweaver; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_fields_have_an_interface_without_torch():
    modules = "mmweaver.compression.signal_field, mmweaver.compression.signal_field"
    code = f"import sys, {modules}; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_samples_are_compressed_without_torch(tmp_path):
    """Starting it takes longer than most recordings."""
    recording, out = tmp_path / "adc_data.bin", tmp_path / "adc_data.mmwl"
    recording.write_bytes(bytes(2 * bytes_of_frame(PRESETS["awr1843"])))
    given = ["compress", str(recording), "--radar", "awr1843", "--quality", "lossless", "-o", str(out), "--quiet"]
    code = f"import sys, mmweaver.cli.main as m; m.main({given!r}); assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert out.is_file()
