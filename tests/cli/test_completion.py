"""mmweaver completion: a script for each shell that knows the commands and options."""

import subprocess

import pytest

from mmweaver.cli.main import main


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_the_script_knows_commands_and_options(shell: str, capsys: pytest.CaptureFixture[str]):
    pytest.importorskip("shtab")
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    for word in ("generate", "decompress", "no-pictures", "background"):
        assert word in script
    if shell == "bash":
        subprocess.run(["bash", "-n"], input=script, text=True, check=True)


def test_another_shell_is_refused(capsys: pytest.CaptureFixture[str]):
    assert main(["completion", "fish"]) == 2
    assert "bash" in capsys.readouterr().err
