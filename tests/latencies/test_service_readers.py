"""The clients refuse damaged messages about as fast as they read the largest undamaged ones."""

import contextlib
import random
import time

from test_readers import READERS, damaged_copy, read_damaged, write_messages


def processor_time(read, data):
    """Returns the seconds that a message takes, the least of several times."""
    times = []
    for _ in range(3):
        start = time.thread_time()
        with contextlib.suppress(ValueError):
            read(data)
        times.append(time.thread_time() - start)
    return min(times)


async def test_the_python_client_reads_damaged_messages_fast(server, tmp_path):
    await write_messages(server, tmp_path)
    rng = random.Random(11)
    undamaged = damaged = 0
    for kind, read in READERS.items():
        for file in sorted(tmp_path.glob(f"*.{kind}")):
            whole = file.read_bytes()
            undamaged = max(undamaged, processor_time(read, whole))
            damaged = max(damaged, *(processor_time(read, damaged_copy(whole, rng)) for _ in range(200)))
    print(f"the slowest damaged message takes {damaged / undamaged:.2f} times as long as the slowest undamaged one")
    assert damaged < 20 * undamaged


async def test_the_typescript_client_reads_damaged_messages_fast(server, tmp_path):
    await write_messages(server, tmp_path)
    counts = read_damaged(tmp_path)
    damaged, undamaged = (max(count[name] for count in counts.values()) for name in ("slowest", "slowestUndamaged"))
    print(f"the slowest damaged message takes {damaged / undamaged:.2f} times as long as the slowest undamaged one")
    assert damaged < 20 * undamaged
