//! Files that appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::SimError;

/// Bytes collected before the system is asked to write.
const BUFFER: usize = 1 << 16;

/// A file under a temporary name; it goes away again unless it is kept.
pub(crate) struct WholeFile {
    partial: PathBuf,
    target: PathBuf,
}

impl WholeFile {
    /// Writes everything under a temporary name in the same folder.
    pub(crate) fn write(
        folder: &Path,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<Self, SimError> {
        let file = Self { partial: folder.join(format!(".{name}.partial")), target: folder.join(name) };
        let written = File::create(&file.partial).and_then(|out| {
            let mut out = BufWriter::with_capacity(BUFFER, out);
            fill(&mut out)?;
            out.flush()
        });
        written.map_err(|source| SimError::Io { path: file.target.clone(), source })?;
        Ok(file)
    }

    /// Gives the file its name; a file that had it before is replaced.
    pub(crate) fn keep(self) -> Result<(), SimError> {
        fs::rename(&self.partial, &self.target)
            .map_err(|source| SimError::Io { path: self.target.clone(), source })
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        // After `keep` there is nothing to remove; otherwise a left-over does no harm.
        let _ = fs::remove_file(&self.partial);
    }
}
