"""What the command line does not pay for."""

import subprocess
import sys


def test_the_command_line_starts_without_torch():
    code = "import sys, mmweaver.cli.main, mmweaver; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_fields_have_an_interface_without_torch():
    code = "import sys, mmweaver.fields.field, mmweaver.fields.phase_centring; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
