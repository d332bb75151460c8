"""The Hub's client is silent while it is asked."""

import logging

import pytest

from mmweaver.core.optional_packages import hub_log_off


def test_it_is_silent_and_then_as_before(caplog: pytest.LogCaptureFixture):
    client, child = logging.getLogger("huggingface_hub"), logging.getLogger("huggingface_hub.utils._http")
    before = (client.level, child.disabled)
    with hub_log_off():
        child.warning("Retrying in 1s")
        client.warning("Retrying in 2s")
    assert not caplog.records
    assert (client.level, child.disabled) == before
