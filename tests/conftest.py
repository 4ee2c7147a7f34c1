from collections import deque

import pytest
from hypothesis import settings

from beamenv.task import resolve

settings.register_profile("reproducible", derandomize=True, deadline=None)
settings.load_profile("reproducible")


@pytest.fixture(scope="session", autouse=True)
def kept_blades():
    """The last blades and tasks: what an environment ends with is gone, and each test would build the default blade anew."""
    kept, shared = deque(maxlen=48), resolve.shared

    def keeping(made):
        found = shared(made)  # not kept[-1]: threads of tests keep theirs meanwhile
        kept.append(found)
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(resolve, "shared", keeping)
        yield kept
