"""The page that plays without a server holds all it needs."""

import re
from base64 import b64decode

import numpy as np

from mmweaver.viz.body_in_photo import unpack
from mmweaver.viz.html_page import offline_page, page_file
from mmweaver.viz.sequence import Playback

SEQUENCE = Playback(header={"frames": 1}, arrays={"range_time": np.zeros((1, 4), np.uint8)})


def test_the_data_is_inside():
    page = offline_page(SEQUENCE, None, "a <title> & more")
    held = re.search(r'id="sequence">([^<]+)<', page)
    assert held is not None
    header, arrays = unpack(b64decode(held[1]))
    assert header == {"frames": 1}
    assert arrays["range_time"].shape == (1, 4)
    assert "<title>a &lt;title&gt; &amp; more</title>" in page


def test_nothing_is_fetched():
    page = offline_page(SEQUENCE, None, "title")
    assert not re.search(r"""(?:src|href)=["'](?!data:)""", page.replace(page_file("mmweaver.js").decode(), ""))
    assert page.count("</script>") == 2
    assert "connect-src" not in page  # default-src 'none' forbids every request
    assert "default-src 'none'" in page
