//! Tests the recorded reference data in the repository.

use sil_harness::files::check_directory;
use std::path::Path;

fn directory() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/reference"))
}

#[test]
fn core_and_plant_agree_with_the_recorded_data() {
    let report = check_directory(directory()).unwrap();
    println!("{report}");
    assert!(report.passed());
    assert!(report.unknown_files.is_empty());
    for stem in [
        "plant",
        "linearisation",
        "LQR",
        "EKF",
        "lidar",
        "occupancy",
        "rays",
        "RRT*",
        "QP",
    ] {
        assert!(
            report.kinds.iter().any(|kind| kind.kind.contains(stem)),
            "{stem}"
        );
    }
}

/// Every kind of file notices a changed number.
#[test]
fn a_changed_number_is_noticed() {
    let changes = [
        (
            "ray_037.json",
            "\"origin_row_col\":[",
            "\"origin_row_col\":[1",
        ),
        ("lqr.json", "\"K\":[[-0.58", "\"K\":[[-0.59"),
        ("lidar_005.json", "\"rays_dx_dz\":[[", "\"rays_dx_dz\":[[1"),
        ("rrt_017.json", "\"stream\":[0.", "\"stream\":[0.3"),
        ("ekf.json", "\"estimates\":[[1", "\"estimates\":[[2"),
        (
            "plant_open_loop.json",
            "\"states\":[[0.0,50",
            "\"states\":[[0.0,51",
        ),
        (
            "linearization.json",
            "\"A_reference\":[[-0.2",
            "\"A_reference\":[[-0.3",
        ),
        (
            "case_001.json",
            "\"ref_points\":[[10",
            "\"ref_points\":[[11",
        ),
        (
            "case_005.json",
            "\"lp_min_max_violation\":",
            "\"lp_min_max_violation\":-",
        ),
        ("coherent_command.json", "\"result\":[18", "\"result\":[19"),
    ];
    for (file, from, to) in changes {
        let text = std::fs::read_to_string(directory().join(file)).unwrap();
        assert!(text.contains(from), "{file} holds {from}");
        let scratch =
            std::env::temp_dir().join(format!("mpp-recorded-{}-{file}", std::process::id()));
        std::fs::create_dir_all(&scratch).unwrap();
        std::fs::write(scratch.join(file), text.replacen(from, to, 1)).unwrap();
        let report = check_directory(&scratch).unwrap();
        std::fs::remove_dir_all(&scratch).unwrap();
        assert!(!report.passed(), "{file}: {report}");
    }
}
