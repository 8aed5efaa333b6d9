//! Where the text of a log comes from: files, standard input, compressed or not.

use std::fs::File;
use std::io::{self, BufReader, Cursor, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::{MapError, Observer};

/// A stream of text with the name that messages call it by.
pub(super) struct Source<'a> {
    pub(super) name: String,
    pub(super) text: Box<dyn Read + Send + 'a>,
}

const STDIN: &str = "-";
const GZIP: &[u8] = &[0x1F, 0x8B];
const ZSTD: &[u8] = &[0x28, 0xB5, 0x2F, 0xFD];

impl<'a> Source<'a> {
    /// Opens a file, or standard input for `-`.
    pub(super) fn open(path: &Path, observer: &'a dyn Observer) -> Result<Self, MapError> {
        if path.as_os_str() == STDIN {
            return Self::new("<stdin>", io::stdin(), observer);
        }
        let failed = |what: &str, source| MapError::Io { path: path.into(), what: what.into(), source };
        let file =
            File::open(path).map_err(|error| failed("cannot be opened; check its name and rights", error))?;
        if file.metadata().is_ok_and(|metadata| metadata.is_dir()) {
            let error = io::ErrorKind::IsADirectory.into();
            return Err(failed("is a directory; name the log file inside it", error));
        }
        Self::new(&path.display().to_string(), file, observer)
    }

    /// Wraps a stream. Its first bytes tell whether it is compressed, not its name: so a file that
    /// some other program packed, unpacked or renamed is read all the same.
    pub(super) fn new(
        name: &str,
        raw: impl Read + Send + 'a,
        observer: &'a dyn Observer,
    ) -> Result<Self, MapError> {
        let failed = |source| match observer.interrupted() {
            true => MapError::Interrupted,
            false => MapError::Io { path: name.into(), what: "cannot be read".into(), source },
        };
        let mut raw = Watched { raw, observer };
        let mut head = Vec::new();
        raw.by_ref().take(ZSTD.len() as u64).read_to_end(&mut head).map_err(failed)?;
        let (gzip, zstd) = (head.starts_with(GZIP), head.starts_with(ZSTD));
        let whole = Cursor::new(head).chain(raw);
        let text: Box<dyn Read + Send + 'a> = if gzip {
            Box::new(MultiGzDecoder::new(BufReader::with_capacity(PACKED_BUFFER, whole)))
        } else if zstd {
            Box::new(zstd::stream::read::Decoder::new(whole).map_err(failed)?)
        } else {
            Box::new(whole)
        };
        Ok(Self { name: name.into(), text })
    }
}

/// Compressed bytes taken from the system at once.
const PACKED_BUFFER: usize = 1 << 16;

/// Bytes of all files together, if every one is a file of known size.
pub(super) fn total_bytes<P: AsRef<Path>>(paths: &[P]) -> Option<u64> {
    let size = |path: &Path| {
        let metadata = path.metadata().ok().filter(|_| path.as_os_str() != STDIN)?;
        metadata.is_file().then_some(metadata.len())
    };
    paths.iter().map(|path| size(path.as_ref())).sum()
}

/// Says what is wrong with a stream that ends in an error.
pub(super) fn what_broke(error: &io::Error) -> String {
    if error.kind() == io::ErrorKind::UnexpectedEof {
        return "the compressed data break off here; the file is cut short, copy or pack it again".into();
    }
    format!("reading fails here: {error}; the file or its compression is damaged, copy or pack it again")
}

/// Tells the observer of every byte, as it comes and before it is unpacked, and stops for it: a
/// stream may have no end.
struct Watched<'a, R> {
    raw: R,
    observer: &'a dyn Observer,
}

impl<R: Read> Read for Watched<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.observer.interrupted() {
            return Err(io::Error::other("interrupted"));
        }
        let count = self.raw.read(buffer)?;
        self.observer.advanced(count as u64);
        Ok(count)
    }
}
