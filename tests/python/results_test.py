"""What all results have. In one process, for they take half a minute to make (every_result)."""

import unittest

from pictures import *  # noqa: F403
from schema import *  # noqa: F403

if __name__ == "__main__":
    unittest.main()
