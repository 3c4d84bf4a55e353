"""Many simulations at once."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Callable, Iterable, TypeVar

from . import _musclesim

Item = TypeVar("Item")
Result = TypeVar("Result")


def ensemble(work: Callable[[Item], Result], items: Iterable[Item], threads: int = 0) -> list[Result]:
    """Calls work(item) for every item on several threads and returns the results in the order of the items.

        angles = musclesim.ensemble(lambda seed: musclesim.run("elbow", "random", 10, seed=seed)["angle_elbow_deg"], range(100))

    threads: 0: one per processor. Runs, replays, diagnoses and steps give Python's lock away, so they go on in parallel; controllers and
    force laws in Python take turns. Each call must build its own simulations. Results do not depend on the number of threads. If calls
    raise, the exception of the first item is raised, after the others have ended; Ctrl-C ends all of them.
    """
    stop = _musclesim._Stop()
    with ThreadPoolExecutor(threads or os.cpu_count(), initializer=stop.follow) as pool:
        futures = [pool.submit(work, item) for item in items]
        try:
            return [future.result() for future in futures]
        except KeyboardInterrupt:
            stop.set()
            for future in futures:
                future.cancel()
            raise
