//! How much memory is free: the machine's, that of control groups, the limits of the process; all of systems that are folders.

use pathtracer::render::available_bytes_below;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const MACHINE: (&str, &str) = (
    "proc/meminfo",
    "MemTotal:       32000 kB\nMemFree:         1000 kB\nMemAvailable:   20000 kB\nBuffers:            0 kB\n",
);

/// A system with these files.
fn system(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap_or(Path::new("/"))).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    folder
}

/// Kilobytes that such a machine has.
fn kilobytes(files: &[(&str, &str)]) -> Option<u64> {
    let system = system(&[&[MACHINE][..], files].concat());
    available_bytes_below(system.path()).map(|bytes| bytes / 1024)
}

#[test]
fn without_limits_it_is_what_the_machine_has() {
    assert_eq!(kilobytes(&[]), Some(20_000));
    assert_eq!(available_bytes_below(system(&[]).path()), None);
    let unlimited = [
        ("proc/self/cgroup", "0::/a\n"),
        ("sys/fs/cgroup/a/memory.max", "max\n"),
        ("sys/fs/cgroup/a/memory.high", "max\n"),
        ("sys/fs/cgroup/a/memory.current", "4096000\n"),
        (
            "proc/self/limits",
            "Max address space         unlimited            unlimited            bytes     \n",
        ),
        ("proc/self/status", "VmSize:\t    5000 kB\n"),
    ];
    assert_eq!(kilobytes(&unlimited), Some(20_000));
}

#[test]
fn a_control_group_leaves_its_limit_without_what_is_used_for_good() {
    let group = [
        ("proc/self/cgroup", "0::/a/b\n"),
        ("sys/fs/cgroup/a/b/memory.max", "10240000\n"),
        ("sys/fs/cgroup/a/b/memory.current", "4096000\n"),
        (
            "sys/fs/cgroup/a/b/memory.stat",
            "anon 2048000\ninactive_anon 7\ninactive_file 1024000\nactive_file 5\n",
        ),
    ];
    assert_eq!(kilobytes(&group), Some(10_000 - (4_000 - 1_000)));
}

#[test]
fn every_group_above_counts_and_so_does_where_one_is_slowed_down() {
    let groups = [
        ("proc/self/cgroup", "0::/a/b/c\n"),
        ("sys/fs/cgroup/a/b/c/memory.max", "max\n"),
        ("sys/fs/cgroup/a/b/memory.max", "10240000\n"),
        ("sys/fs/cgroup/a/b/memory.current", "1024000\n"),
        ("sys/fs/cgroup/a/memory.max", "max\n"),
        ("sys/fs/cgroup/a/memory.high", "8192000\n"),
        ("sys/fs/cgroup/a/memory.current", "2048000\n"),
    ];
    assert_eq!(kilobytes(&groups), Some(8_000 - 2_000));
    assert_eq!(kilobytes(&groups[..4]), Some(10_000 - 1_000));
}

#[test]
fn a_container_that_sees_its_own_group_as_the_top_one_has_its_limit() {
    for path in ["/", "/docker/0123", "/../../elsewhere"] {
        let group = format!("0::{path}\n");
        let files = [
            ("proc/self/cgroup", group.as_str()),
            ("sys/fs/cgroup/memory.max", "10240000\n"),
            ("sys/fs/cgroup/memory.current", "1024000\n"),
        ];
        assert_eq!(kilobytes(&files), Some(9_000), "{path}");
    }
}

#[test]
fn groups_of_the_first_version_count_too() {
    let groups = [
        ("proc/self/cgroup", "5:cpu,cpuacct:/\n4:hugetlb,memory:/slurm/job\n1:name=systemd:/other\n0::/\n"),
        ("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"),
        ("sys/fs/cgroup/memory/memory.usage_in_bytes", "99999999999\n"),
        ("sys/fs/cgroup/memory/slurm/job/memory.limit_in_bytes", "10240000\n"),
        ("sys/fs/cgroup/memory/slurm/job/memory.usage_in_bytes", "5120000\n"),
        ("sys/fs/cgroup/memory/slurm/job/memory.stat", "inactive_file 1\ntotal_inactive_file 2048000\n"),
        ("sys/fs/cgroup/memory/other/memory.limit_in_bytes", "1\n"),
    ];
    assert_eq!(kilobytes(&groups), Some(10_000 - (5_000 - 2_000)));
}

#[test]
fn a_group_over_its_limit_leaves_nothing() {
    let group = [
        ("proc/self/cgroup", "0::/a\n"),
        ("sys/fs/cgroup/a/memory.max", "1024000\n"),
        ("sys/fs/cgroup/a/memory.current", "2048000\n"),
    ];
    assert_eq!(kilobytes(&group), Some(0));
}

#[test]
fn limits_of_the_process_leave_what_it_does_not_use() {
    let limits = |addresses: &str, data: &str| {
        format!(
            "Limit                     Soft Limit           Hard Limit           Units     \n\
             Max data size             {data}            unlimited            bytes     \n\
             Max stack size            8388608              unlimited            bytes     \n\
             Max address space         {addresses}           unlimited            bytes     \n"
        )
    };
    for (addresses, data, expected) in [
        ("10240000", "unlimited", 10_000 - 5_000),
        ("unlimited", "8192000", 8_000 - 1_000),
        ("15360000", "8192000", 8_000 - 1_000),
        ("4096000", "unlimited", 0),
        ("unlimited", "unlimited", 20_000),
    ] {
        let limits = limits(addresses, data);
        let files = [
            ("proc/self/limits", limits.as_str()),
            (
                "proc/self/status",
                "Name:\tpathtracer\nVmPeak:\t    9000 kB\nVmSize:\t    5000 kB\nVmData:\t    1000 kB\n",
            ),
        ];
        assert_eq!(kilobytes(&files), Some(expected), "{addresses}, {data}");
    }
}
