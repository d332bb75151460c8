"""mmweaver completion: completion of commands and options for a shell."""

import argparse
from typing import Any

from mmweaver.core.optional_packages import need

EXAMPLES = """examples:
  mmweaver completion bash > ~/.local/share/bash-completion/completions/mmweaver
  mmweaver completion zsh > ~/.zfunc/_mmweaver       # with fpath+=~/.zfunc before compinit in ~/.zshrc
  mmweaver completion tcsh > ~/.mmweaver.tcsh        # and source it in ~/.tcshrc
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "completion", help="print a shell's completion script", epilog=EXAMPLES,
        description="Prints a script that completes mmweaver's commands, options and files in a shell.",
    )  # fmt: skip
    parser.add_argument("shell", choices=("bash", "zsh", "tcsh"), help="which shell")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Prints the script on stdout. Raises InputError where shtab is not installed."""
    need("completion", "completion", "shtab")
    import shtab

    print(shtab.complete(arguments.whole_parser, shell=arguments.shell))
    return 0
