//! Writing tables of FlatBuffers from the front to the back: a table, then what it refers to.

/// A buffer with its length before it, as it is in the file.
pub(super) struct Builder {
    /// Positions are counted from the length, as other writers align them.
    bytes: Vec<u8>,
}

/// A value of a table.
#[derive(Debug, Clone, Copy)]
pub(super) enum Slot {
    Byte(u8),
    Short(u16),
    Int(i32),
    Long(u64),
    /// The position of a table or list, which is filled in when that is added.
    Offset,
}

impl Slot {
    fn size(self) -> usize {
        match self {
            Slot::Byte(_) => 1,
            Slot::Short(_) => 2,
            Slot::Int(_) | Slot::Offset => 4,
            Slot::Long(_) => 8,
        }
    }
}

/// A position in a table that is to refer to something that is added later.
#[derive(Debug, Clone, Copy)]
#[must_use]
pub(super) struct Open(usize);

impl Builder {
    /// Begins a buffer; the first table is for the returned position.
    pub(super) fn new() -> (Self, Open) {
        let bytes = vec![0; 8];
        (Builder { bytes }, Open(4))
    }

    /// Fills with zeros until the position, with so many bytes added, is a multiple of `size`.
    fn align(&mut self, size: usize, added: usize) {
        while !(self.bytes.len() + added).is_multiple_of(size) {
            self.bytes.push(0);
        }
    }

    fn refer(&mut self, open: Open, to: usize) {
        let offset = (to - open.0) as u32;
        self.bytes[open.0..open.0 + 4].copy_from_slice(&offset.to_le_bytes());
    }

    /// Adds a table with these values by their slots, and returns the positions of its offsets, in
    /// the order of the values.
    pub(super) fn table(&mut self, of: Open, values: &[(usize, Slot)]) -> Vec<Open> {
        let slots = values.iter().map(|&(slot, _)| slot + 1).max().unwrap_or(0);
        let length = 4 + 2 * slots;
        // Larger values first, so that none needs a gap; the table begins 4 bytes before a
        // multiple of 8.
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by_key(|&i| std::cmp::Reverse(values[i].1.size()));
        self.align(8, length + 4);
        let vtable = self.bytes.len();
        let table = vtable + length;
        self.bytes.resize(table + 4, 0);
        self.bytes[table..].copy_from_slice(&(length as i32).to_le_bytes());
        let mut opens = Vec::new();
        for i in order {
            let (slot, value) = values[i];
            let at = self.bytes.len();
            match value {
                Slot::Byte(byte) => self.bytes.push(byte),
                Slot::Short(short) => self.bytes.extend_from_slice(&short.to_le_bytes()),
                Slot::Int(int) => self.bytes.extend_from_slice(&int.to_le_bytes()),
                Slot::Long(long) => self.bytes.extend_from_slice(&long.to_le_bytes()),
                Slot::Offset => {
                    opens.push((i, Open(at)));
                    self.bytes.extend_from_slice(&[0; 4]);
                }
            }
            let offset = (at - table) as u16;
            let entry = vtable + 4 + 2 * slot;
            self.bytes[entry..entry + 2].copy_from_slice(&offset.to_le_bytes());
        }
        let size = (self.bytes.len() - table) as u16;
        self.bytes[vtable..vtable + 2].copy_from_slice(&(length as u16).to_le_bytes());
        self.bytes[vtable + 2..vtable + 4].copy_from_slice(&size.to_le_bytes());
        self.refer(of, table);
        opens.sort_unstable_by_key(|&(i, _)| i);
        opens.into_iter().map(|(_, open)| open).collect()
    }

    /// Adds a list of items that have this size, and returns its bytes for them.
    fn list(&mut self, of: Open, count: usize, size: usize) {
        self.align(size.max(4), 4);
        self.refer(of, self.bytes.len());
        self.bytes.extend_from_slice(&(count as u32).to_le_bytes());
    }

    pub(super) fn doubles(&mut self, of: Open, numbers: impl ExactSizeIterator<Item = f64>) {
        self.list(of, numbers.len(), 8);
        numbers.for_each(|number| self.bytes.extend_from_slice(&number.to_le_bytes()));
    }

    pub(super) fn words(&mut self, of: Open, words: impl ExactSizeIterator<Item = u32>) {
        self.list(of, words.len(), 4);
        words.for_each(|word| self.bytes.extend_from_slice(&word.to_le_bytes()));
    }

    pub(super) fn bytes(&mut self, of: Open, bytes: &[u8]) {
        self.list(of, bytes.len(), 1);
        self.bytes.extend_from_slice(bytes);
    }

    /// Adds a text, which ends with a zero that is not counted.
    pub(super) fn text(&mut self, of: Open, text: &str) {
        self.bytes(of, text.as_bytes());
        self.bytes.push(0);
    }

    /// Adds a list of tables, and returns the position of each.
    pub(super) fn tables(&mut self, of: Open, count: usize) -> Vec<Open> {
        self.list(of, count, 4);
        let start = self.bytes.len();
        self.bytes.resize(start + 4 * count, 0);
        (0..count).map(|i| Open(start + 4 * i)).collect()
    }

    /// Returns the bytes; `None` if they are more than the format has room for.
    pub(super) fn finish(mut self) -> Option<Vec<u8>> {
        self.align(8, 4);
        let length = i32::try_from(self.bytes.len() - 4).ok()?;
        self.bytes[..4].copy_from_slice(&length.to_le_bytes());
        Some(self.bytes)
    }
}
