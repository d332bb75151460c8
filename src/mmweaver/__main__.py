"""`python -m mmweaver` is the mmweaver command."""

import sys

from mmweaver.cli.main import main

sys.exit(main())
