//! Output that is written whole or not at all.
//!
//! A regular file is written beside its final place under a temporary name, brought to the disk
//! and then renamed, so a reader sees either the old file or the complete new one. When anything
//! fails, the temporary file is removed and the old file stays as it was.
//!
//! `-` is standard output. A device or a pipe (`/dev/null`, a shell's `>(gzip)`) cannot be
//! replaced by renaming and is written directly.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::MapError;

/// Bytes gathered before they go to the system.
const BUFFER: usize = 1 << 17;

/// An output that is open for writing but of which nobody sees anything yet.
///
/// Opening it before long work finds a path that cannot be written before the work is done.
/// Dropping it unused leaves no trace.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    Stdout,
    /// A device or a pipe.
    Direct(File),
    /// A temporary file, and the regular file that it becomes.
    Staged(NamedTempFile, PathBuf),
}

impl Output {
    /// Prepares the output at `path`; `-` is standard output.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when the path is a folder, is write-protected, or lies in a folder that does
    /// not exist or that takes no new file.
    pub fn open(path: &Path) -> Result<Self, MapError> {
        let place = Place::open(path).map_err(|source| failed(path, source))?;
        Ok(Self { path: path.to_owned(), place })
    }

    /// Writes everything that `contents` produces and puts it in place.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when `contents` fails or the system refuses a byte, as a full disk does.
    /// A regular file is then untouched.
    pub fn write(self, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), MapError> {
        self.fill(contents)?.keep()
    }

    /// Writes everything that `contents` produces, to be put in place later: when another file is complete too.
    ///
    /// # Errors
    /// As [`Output::write`].
    pub fn fill(
        mut self,
        contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Filled, MapError> {
        match self.place.write(contents) {
            Ok(()) => Ok(Filled(self)),
            Err(source) => Err(failed(&self.path, source)),
        }
    }
}

/// An output that is complete but not in place yet. Dropped, a regular file stays as it was.
#[derive(Debug)]
pub struct Filled(Output);

impl Filled {
    /// Puts the output in place.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when the system refuses.
    pub fn keep(self) -> Result<(), MapError> {
        let Output { path, place } = self.0;
        place.keep().map_err(|source| failed(&path, source))
    }
}

/// Opens the output at `path` and writes it whole: [`Output::open`], then [`Output::write`].
///
/// # Errors
/// Those of the two calls.
pub fn write_whole(
    path: &Path,
    contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), MapError> {
    Output::open(path)?.write(contents)
}

/// Makes the folder at `path`, and those that it is in, unless they are there.
///
/// # Errors
/// [`MapError::Unwritable`] when a file stands there or the system refuses.
pub fn make_folder(path: &Path) -> Result<(), MapError> {
    fs::create_dir_all(path).map_err(|source| failed(path, source))
}

impl Place {
    fn open(path: &Path) -> io::Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Stdout);
        }
        let target = match fs::metadata(path) {
            Ok(known) if known.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Ok(known) if !known.is_file() => {
                return OpenOptions::new().write(true).open(path).map(Self::Direct);
            }
            Ok(known) if known.permissions().readonly() => return Err(ErrorKind::PermissionDenied.into()),
            // A symbolic link stays a link; the file that it names is replaced.
            Ok(_) => fs::canonicalize(path)?,
            Err(_) if path.file_name().is_none() => return Err(ErrorKind::NotFound.into()),
            Err(_) => path.to_owned(),
        };
        let folder = target.parent().filter(|parent| !parent.as_os_str().is_empty());
        let temporary = staging().tempfile_in(folder.unwrap_or(Path::new(".")))?;
        Ok(Self::Staged(temporary, target))
    }

    fn write(&mut self, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
        match self {
            Self::Stdout => buffered(io::stdout().lock(), contents),
            Self::Direct(device) => buffered(device, contents),
            Self::Staged(temporary, _) => {
                buffered(temporary.as_file_mut(), contents)?;
                temporary.as_file().sync_all()
            }
        }
    }

    fn keep(self) -> io::Result<()> {
        if let Self::Staged(temporary, target) = self {
            temporary.persist(target).map_err(|refused| refused.error)?;
        }
        Ok(())
    }
}

/// Temporary files with the permissions that any new file of the user gets.
fn staging() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".covimap-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

fn buffered(to: impl Write, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut buffer = BufWriter::with_capacity(BUFFER, to);
    let written = contents(&mut buffer);
    if written.is_err() {
        // Not flushed on drop: what came before a failure is of no use to anybody.
        let _ = buffer.into_parts();
        return written;
    }
    buffer.flush()
}

fn failed(path: &Path, source: io::Error) -> MapError {
    MapError::Unwritable { path: path.to_owned(), what: remedy(source.kind()).to_owned(), source }
}

/// What the user can do about a refusal of the system.
fn remedy(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::AlreadyExists => "a file stands where a folder is wanted; choose another place",
        ErrorKind::NotFound | ErrorKind::NotADirectory => {
            "its folder does not exist; create the folder first"
        }
        ErrorKind::IsADirectory => "it is a folder; give the name of a file",
        ErrorKind::PermissionDenied => "no permission; change it or choose another place",
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only; choose another place",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "no space is left; free some or choose another place"
        }
        ErrorKind::BrokenPipe => "the reader at the other end has gone",
        _ => "the system refused; choose another place",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn refusal(path: &Path) -> String {
        Output::open(path).unwrap_err().to_string()
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        write_whole(&path, |out| out.write_all(b"new and longer")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new and longer");
        assert_eq!(names_in(folder.path()), ["map.json"]);
    }

    #[test]
    fn a_failure_in_the_middle_leaves_the_old_file_and_no_temporary_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        fs::write(&path, "old").unwrap();
        let error = write_whole(&path, |out| {
            out.write_all(&vec![b'x'; 3 * BUFFER])?;
            Err(ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert!(
            error.to_string().ends_with(
                "map.json: cannot be written: no space is left; free some or choose another place"
            )
        );
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["map.json"]);
    }

    #[test]
    fn folders_are_made_with_those_that_they_are_in() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        make_folder(&deep).unwrap();
        make_folder(&deep).unwrap();
        assert!(deep.is_dir());
        fs::write(folder.path().join("file"), "").unwrap();
        let refusal = |name: &str| make_folder(&folder.path().join(name)).unwrap_err().to_string();
        assert!(refusal("file").contains("a file stands where a folder is wanted; choose another place"));
        assert!(refusal("file/below").contains("its folder does not exist"));
    }

    #[test]
    fn an_output_that_is_filled_but_not_kept_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        let fill = || Output::open(&path).unwrap().fill(|out| out.write_all(b"new")).unwrap();
        drop(fill());
        assert!(names_in(folder.path()).is_empty());
        fill().keep().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn an_output_that_is_dropped_unwritten_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        drop(Output::open(&folder.path().join("map.json")).unwrap());
        assert!(names_in(folder.path()).is_empty());
    }

    #[test]
    fn paths_that_cannot_be_written_are_refused_before_any_work() {
        let folder = tempfile::tempdir().unwrap();
        assert!(refusal(folder.path()).contains("it is a folder; give the name of a file"));
        assert!(refusal(&folder.path().join("no/map.json")).contains("its folder does not exist"));
        assert!(refusal(&folder.path().join("no/..")).contains("its folder does not exist"));
        let file = folder.path().join("file");
        fs::write(&file, "kept").unwrap();
        assert!(refusal(&file.join("map.json")).contains("its folder does not exist"));
        let mut protected = fs::metadata(&file).unwrap().permissions();
        protected.set_readonly(true);
        fs::set_permissions(&file, protected).unwrap();
        assert!(refusal(&file).contains("no permission; change it or choose another place"));
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_device_is_written_directly_and_a_full_one_reported() {
        write_whole(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
        let error = write_whole(Path::new("/dev/full"), |out| out.write_all(b"more")).unwrap_err();
        assert!(error.to_string().starts_with("/dev/full: cannot be written: no space is left"));
    }

    #[test]
    #[cfg(unix)]
    fn links_stay_links_and_new_files_get_the_usual_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.json"), folder.path().join("latest.json"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_whole(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        let plain = folder.path().join("plain");
        File::create(&plain).unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&file), mode(&plain));
    }

    #[test]
    fn every_refusal_says_what_to_do() {
        for kind in [ErrorKind::ReadOnlyFilesystem, ErrorKind::FileTooLarge, ErrorKind::TimedOut] {
            assert!(remedy(kind).contains("choose another place"));
        }
        assert!(remedy(ErrorKind::BrokenPipe).contains("reader"));
    }
}
