"""python -m studies: run a study, list all, fill the tables of the documentation, check results."""

import sys

from studies.run import main

sys.exit(main())
