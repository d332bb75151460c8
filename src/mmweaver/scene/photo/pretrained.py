"""Loads pretrained models through `transformers`, from a local folder or from the Hub."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.hub_log import hub_log_off
from mmweaver.core.optional_packages import need


def load_pretrained(source: str, option: str, choose: Callable[[Any, Any], Any]) -> tuple[Any, Any, Any]:
    """Loads a pretrained model for inference on the CPU; safetensors only.

    Args:
        source: Folder or Hub name.
        option: Command-line option, for error messages.
        choose: Called with the `transformers` module and the config; returns the class to load.

    Returns:
        Config, image processor and model in evaluation mode.

    Raises:
        InputError: If `transformers` is missing or the model cannot be loaded.
    """
    need("pretrained", option, "transformers")
    import transformers

    folder = Path(source)
    if folder.is_dir() and not (folder / "config.json").is_file():
        raise InputError(f"{option} {source} is a folder without config.json; give one written by save_pretrained")
    if not folder.is_dir() and (folder.exists() or source.startswith((".", "/", "~"))):
        raise InputError(f"{option} {source} is not a folder; give a model's folder or its name on the Hub")
    with quiet(transformers):
        try:
            config = transformers.AutoConfig.from_pretrained(source)
            model_class = choose(transformers, config)
            processor = transformers.AutoImageProcessor.from_pretrained(source)
            model = model_class.from_pretrained(source, use_safetensors=True)
        except InputError:
            raise
        except Exception as error:  # third-party files may fail in any way
            if isinstance(error, MemoryError):
                raise
            raise InputError(_load_error(source, option, error, is_folder=folder.is_dir())) from None
    return config, processor, model.eval()


@contextmanager
def quiet(transformers: Any) -> Iterator[None]:
    """Silences the log lines and progress bars of transformers."""
    logging = transformers.utils.logging
    level = logging.get_verbosity()
    logging.set_verbosity_error()
    logging.disable_progress_bar()
    try:
        with hub_log_off():
            yield
    finally:
        logging.set_verbosity(level)
        logging.enable_progress_bar()


def _load_error(source: str, option: str, error: Exception, *, is_folder: bool) -> str:
    reason = (str(error).strip().splitlines() or [type(error).__name__])[0][:160]
    if is_folder:
        return (
            f"{option} {source} cannot be loaded ({reason}); it needs config.json, preprocessor_config.json and"
            " model.safetensors"
        )
    return (
        f"{option} {source} is not a local folder and cannot be downloaded from the Hub ({reason}); with a network:"
        f" hf download {source} --local-dir DIR, then {option} DIR"
    )
