"""mmweaver completion: completion of commands and options for a shell."""

from typing import Literal

from mmweaver.cli.arguments import General
from mmweaver.core.optional_packages import need
from mmweaver.core.options import MISSING, option, options

EXAMPLES = """examples:
  mmweaver completion bash > ~/.local/share/bash-completion/completions/mmweaver
  mmweaver completion zsh > ~/.zfunc/_mmweaver       # with fpath+=~/.zfunc before compinit in ~/.zshrc
  mmweaver completion tcsh > ~/.mmweaver.tcsh        # and source it in ~/.tcshrc
"""


@options
class Options(General):
    """Prints a script that completes mmweaver's commands, options and files in a shell."""

    shell: Literal["bash", "zsh", "tcsh"] = option("which shell", default=MISSING, positional=True)


def run(asked: Options) -> int:
    """Prints the script on stdout.

    Raises:
        InputError: If shtab is not installed.
    """
    need("completion", "completion", "shtab")
    import shtab

    from mmweaver.cli.main import build_parser

    print(shtab.complete(build_parser(), shell=asked.shell))
    return 0
