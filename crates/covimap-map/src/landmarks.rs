//! Landmarks: dense numbers inside, strings at the border.

/// Dense number of a landmark: its place in the order of first sighting in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LandmarkId(pub u32);

impl LandmarkId {
    /// As an index into per-landmark arrays.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The string IDs of all landmarks, in the order of [`LandmarkId`], in one piece of memory.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LandmarkNames {
    text: String,
    ends: Vec<usize>,
}

impl LandmarkNames {
    /// Appends a name and returns the number it got. The caller sees to it that names differ.
    pub fn push(&mut self, name: &str) -> LandmarkId {
        let id =
            LandmarkId(u32::try_from(self.ends.len()).expect("fewer than 2^32 landmarks (bug in covimap)"));
        self.text.push_str(name);
        self.ends.push(self.text.len());
        id
    }

    /// Number of landmarks.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no landmark.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The string ID of a landmark.
    #[must_use]
    pub fn name(&self, id: LandmarkId) -> &str {
        let start = if id.0 == 0 { 0 } else { self.ends[id.index() - 1] };
        &self.text[start..self.ends[id.index()]]
    }

    /// All string IDs in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        (0..self.len())
            .map(|index| self.name(LandmarkId(u32::try_from(index).expect("fits (bug in covimap)"))))
    }
}

impl<'a> FromIterator<&'a str> for LandmarkNames {
    fn from_iter<I: IntoIterator<Item = &'a str>>(names: I) -> Self {
        let mut all = Self::default();
        for name in names {
            all.push(name);
        }
        all
    }
}
