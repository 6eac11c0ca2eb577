"""Available memory, by machine and cgroup limits; results that do not fit are rejected."""

import re
import sys

import pytest

from polhode._support import memory as _memory

GB = 10**9


@pytest.fixture
def system(tmp_path, monkeypatch):
    """Write files of a fake /proc and /sys/fs/cgroup."""
    monkeypatch.setattr(_memory, "_PROC", str(tmp_path / "proc"))
    monkeypatch.setattr(_memory, "_CGROUP", str(tmp_path / "cgroup"))

    def write(**files):
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    return write


def group(inside, limit, usage, cache=0):
    """The files of a cgroup, version 2."""
    return {
        f"{inside}__memory.max": f"{limit}\n",
        f"{inside}__memory.current": f"{usage}\n",
        f"{inside}__memory.stat": f"anon 12\ninactive_file {cache}\nactive_file 5\n",
    }


def machine(free):
    return {"proc__meminfo": f"MemTotal: {2 * free // 1024} kB\nMemAvailable:   {free // 1024} kB\n"}


def test_unknown_memory(system):
    assert _memory.available() is None
    _memory.require(10**30, "states")


def test_memory_of_the_machine(system):
    system(**machine(1024 * GB))
    assert _memory.available() == 1024 * GB


def test_a_cgroup_limits_memory(system):
    system(
        **machine(1024 * GB),
        proc__self__cgroup="0::/\n",
        **group("cgroup", 8 * GB, 3 * GB, cache=GB),
    )
    assert _memory.available() == 6 * GB


def test_parent_cgroups_limit_memory(system):
    system(
        **machine(1024 * GB),
        proc__self__cgroup="0::/outer/inner\n",
        **group("cgroup__outer", 8 * GB, 3 * GB),
        **group("cgroup__outer__inner", "max", GB),
    )
    assert _memory.available() == 5 * GB


def test_cgroup_path_of_the_host(system):
    system(proc__self__cgroup="0::/kubepods/pod-12:34\n", **group("cgroup", 2 * GB, 3 * GB))
    assert _memory.available() == 0


def test_cgroups_v1(system):
    system(
        **machine(1024 * GB),
        proc__self__cgroup="5:cpu,cpuacct:/\n4:memory:/job\n0::/\n",
        **{
            "cgroup__memory__job__memory.limit_in_bytes": f"{9 * GB}\n",
            "cgroup__memory__job__memory.usage_in_bytes": f"{4 * GB}\n",
            "cgroup__memory__job__memory.stat": f"inactive_file 7\ntotal_inactive_file {GB}\n",
            # No limit, as the kernel writes it.
            "cgroup__memory__memory.limit_in_bytes": "9223372036854771712\n",
            "cgroup__memory__memory.usage_in_bytes": f"{5 * GB}\n",
        },
    )
    assert _memory.available() == 6 * GB


def test_the_error_gives_both_numbers(system):
    system(**machine(22 * 1000 * 1024 * 1024))
    message = "states of 10000000 bodies at 1000 times take 560 GB; 23.1 GB are free: ask for fewer"
    with pytest.raises(MemoryError, match=re.escape(message)):
        _memory.require(560 * GB, "states of 10000000 bodies at 1000 times")
    _memory.require(23 * GB, "states")


@pytest.mark.parametrize(
    ("count", "text"), [(0, "0 bytes"), (999_499, "999 kB"), (999_500, "1 MB"), (5 * 10**24, "5e+06 EB")]
)
def test_sizes_have_three_digits(count, text):
    assert _memory.size(count) == text


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux reports it")
def test_memory_of_this_machine():
    assert _memory.available() > 0
