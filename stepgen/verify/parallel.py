"""
Work that is done in several processes at once.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from typing import Any, TypeVar

Job = TypeVar("Job", bound=tuple[Any, ...])
Result = TypeVar("Result")


def in_processes(
    work: Callable[..., Result],
    jobs: Sequence[Job],
    count: int,
    track: Callable[[Any], Iterable[Any]],
) -> dict[Job, Result]:
    """
    Return what *work* gives for the arguments of each of *jobs*, in their order.

    Args:
        work: A function of a module, which other processes can import.
        jobs: The arguments of each call.
        count: How many processes there are.
        track: Shows progress; passes on what has a length, in the order of its end.

    Raises:
        Exception: What the first job that failed raised.
    """
    with ProcessPoolExecutor(max_workers=count) as pool:
        futures = {pool.submit(work, *job): job for job in jobs}
        for _ in track(_Finishing(futures)):
            pass
    return {job: future.result() for future, job in futures.items()}


class _Finishing:
    """
    The futures in the order in which they finish, with a length for a progress bar.
    """

    def __init__(self, futures: Mapping[Future[Any], Any]) -> None:
        self._futures = futures

    def __len__(self) -> int:
        return len(self._futures)

    def __iter__(self) -> Iterator[Future[Any]]:
        return as_completed(self._futures)
