//! A folder of its own for every test, and runs of the program in it.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// Four landmarks in a square, each seen with its neighbours more often than with its opposite.
pub const SQUARE: &str = r#"{"seen": ["A", "B"]}
{"seen": ["B", "C"]}
{"seen": ["C", "D"]}
{"seen": ["D", "A"]}
{"seen": ["A", "B", "C"]}
{"seen": ["C", "D", "A"]}
"#;

/// A folder that is gone after the test.
pub struct Scratch {
    folder: TempDir,
}

/// What a run left behind.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Scratch {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A folder with the file `square.jsonl`.
    pub fn with_square() -> Self {
        let scratch = Self::new();
        scratch.file("square.jsonl", SQUARE);
        scratch
    }

    /// A folder with the map of the square.
    pub fn with_map() -> Self {
        let scratch = Self::with_square();
        scratch.succeeds(&["build", "square.jsonl", "-q"]);
        scratch
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a file and returns its path.
    pub fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.folder.path().join(name);
        fs::write(&path, contents).unwrap();
        path
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }

    /// Names of all files, hidden ones too, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The program with arguments, in this folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_covimap"));
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Run {
        Run::of(&mut self.command(arguments))
    }

    /// Runs the program, which must do its work.
    pub fn succeeds(&self, arguments: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.code, Some(0), "{run:?}");
        run
    }

    /// Runs the program, which must refuse: exit code, message, no result and no new file.
    #[track_caller]
    pub fn refuses(&self, arguments: &[&str], code: i32, message: &str) {
        let before = self.names();
        let run = self.run(arguments);
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!(run.stderr.contains(message), "{message:?} is not in {run:?}");
        assert_eq!(run.stdout, "");
        assert_eq!(self.names(), before);
    }
}

impl Run {
    pub fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// Standard output as the one JSON object that it must be.
    pub fn json(&self) -> serde_json::Value {
        let value: serde_json::Value = serde_json::from_str(&self.stdout).unwrap();
        assert!(value.is_object(), "{value}");
        value
    }
}

/// The robot log that is built into the program.
pub fn robot_log() -> String {
    fs::read_to_string(data("mrclam-1.jsonl")).unwrap()
}

/// A file of `data/`.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}
