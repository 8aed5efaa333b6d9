//! `covimap demo`.

use crate::scratch::{Run, Scratch};

#[test]
fn the_robot_log_is_mapped_twice_compared_and_drawn() {
    let scratch = Scratch::new();
    let run = scratch.succeeds(&["demo"]);
    assert_eq!(scratch.names(), ["covimap-demo.svg"]);
    assert_eq!(run.stderr, "picture written to covimap-demo.svg\n");
    assert!(run.stdout.contains("15 landmarks in 1 component"), "{}", run.stdout);
    let orientation = |column| error(&run, "triangles turned the wrong way", column);
    let delaunay = |column| error(&run, "Delaunay edges that differ", column);
    let (auto, classical) = (0, 1);
    assert!(orientation(auto) < orientation(classical), "{}", run.stdout);
    assert!(delaunay(auto) < delaunay(classical), "{}", run.stdout);
    assert_eq!(scratch.succeeds(&["demo", "--threads", "2"]).stdout, run.stdout);
}

/// A number in the table of errors.
fn error(run: &Run, name: &str, column: usize) -> f64 {
    let row = run.stdout.lines().find_map(|line| line.strip_prefix(name)).unwrap();
    row.split_whitespace().nth(column).unwrap().parse().unwrap()
}

#[test]
fn the_picture_shows_every_landmark() {
    let scratch = Scratch::new();
    scratch.succeeds(&["demo", "-q", "-o", "robot.svg"]);
    assert_eq!(scratch.names(), ["robot.svg"]);
    let picture = scratch.read("robot.svg");
    for post in 6..=20 {
        assert!(picture.contains(&format!("\nL{post}\n")), "L{post} is not in the picture");
    }
}

#[test]
fn the_trial_of_the_paper_is_mapped() {
    let scratch = Scratch::new();
    let run = scratch.succeeds(&["demo", "--paper"]);
    assert!(run.stdout.contains("6 landmarks in 1 component and 1 region, 9 pairs"), "{}", run.stdout);
    assert!(run.stdout.contains("warning: few_partners (2)"), "{}", run.stdout);
    assert_eq!(scratch.names(), ["covimap-demo.svg"]);
}
