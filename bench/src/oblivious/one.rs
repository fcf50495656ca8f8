//! One file sorted or transposed by a process of its own: its peak of memory and its I/O are those of the work.

use super::*;
use std::io;
use taut_oblivious::external::KeyKind;

/// A record has this many bytes, the first eight of which are its key.
pub(super) const RECORD_BYTES: usize = 32;

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Work {
    /// Sort by taut.
    Sort,
    /// Sort by the crate extsort.
    Extsort,
    /// Put all records into taut's queue for more than memory holds, and take them out.
    Queue,
    /// Transpose doubles by taut.
    Transpose,
    /// Read and write as many bytes in turn past the page cache: what the disk allows who does one thing at a time.
    Disk,
    /// Copy: what the disk and the page cache allow.
    Copy,
}

/// One file.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    pub(super) work: Work,
    /// Bytes of memory.
    pub(super) memory: usize,
    /// Rows of a matrix to transpose.
    pub(super) rows: u64,
    pub(super) from: PathBuf,
    pub(super) to: PathBuf,
}

/// What it cost.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct FileCost {
    /// Processor seconds of the process.
    pub(super) cpu: f64,
    /// Seconds by the clock.
    pub(super) wall: f64,
    /// Bytes of the process at its peak.
    pub(super) peak: Option<u64>,
    /// Bytes asked of the system to read and to write, by its own account.
    pub(super) io: Option<u64>,
    /// The same by the account of taut.
    pub(super) counted: Option<u64>,
    /// The certificate of a sort by taut: records, and their hash in two halves.
    pub(super) certificate: Option<(u64, [u64; 2])>,
}

/// Records with a key of eight bytes, least significant first.
fn layout() -> RecordLayout {
    RecordLayout { width: RECORD_BYTES, key: 0..8, kind: KeyKind::U64 }
}

impl Task {
    /// Does it, and tells what it cost.
    pub(crate) fn perform(&self) -> Result<FileCost> {
        // As the peer: one thread.
        rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
        let Task { work, memory, rows, from, to } = self;
        let monitor = Monitor::silent();
        let (mut counted, mut certificate) = (None, None);
        let before = asked();
        let meter = Meter::start();
        match work {
            Work::Sort => {
                let options = FileSortOptions { memory: *memory, ..Default::default() };
                let done = sort_file(from, to, &layout(), &options, &monitor)?;
                counted = Some(done.bytes_read + done.bytes_written);
                let hash = done.certificate.hash;
                certificate = Some((done.certificate.records, [(hash >> 64) as u64, hash as u64]));
            }
            Work::Extsort => extsort(from, to, *memory)?,
            Work::Queue => queue(from, to, *memory)?,
            Work::Transpose => {
                let columns = from.metadata()?.len() / 8 / rows;
                let matrix = FileMatrix { rows: *rows, columns, width: 8, offset: 0 };
                let options = TransposeFileOptions { memory: *memory };
                let done = transpose_file(from, matrix, to, &[], &options, &monitor)?;
                counted = Some(done.bytes_read + done.bytes_written);
            }
            Work::Disk => disk(from, to)?,
            Work::Copy => copy(from, to)?,
        }
        let cost = meter.stop();
        let io = asked().zip(before).map(|(after, before)| after - before);
        let peak = meter::peak();
        Ok(FileCost { cpu: cost.cpu, wall: cost.wall, peak, io, counted, certificate })
    }
}

/// Bytes that this process has asked the system to read and to write; `None` where /proc does not tell.
fn asked() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/io").ok()?;
    let field = |name| {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.trim().parse::<u64>().ok()
    };
    Some(field("rchar:")? + field("wchar:")?)
}

/// A record, as the peer takes it.
struct Record([u8; RECORD_BYTES]);

impl Record {
    fn key(&self) -> u64 {
        let mut key = [0; 8];
        key.copy_from_slice(&self.0[..8]);
        u64::from_le_bytes(key)
    }
}

impl Sortable for Record {
    fn encode<W: Write>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(&self.0)
    }

    fn decode<R: Read>(reader: &mut R) -> io::Result<Self> {
        let mut bytes = [0; RECORD_BYTES];
        reader.read_exact(&mut bytes)?;
        Ok(Record(bytes))
    }
}

/// The crate: as many records at once as the memory holds, runs beside the output, which is brought to the disk.
fn extsort(from: &Path, to: &Path, memory: usize) -> Result<()> {
    let mut records = BufReader::with_capacity(1 << 20, File::open(from)?);
    let count = from.metadata()?.len() / RECORD_BYTES as u64;
    // A record that cannot be read is missing from the output, which is judged.
    let records = (0..count).map_while(|_| Record::decode(&mut records).ok());
    let sorter = ExternalSorter::new()
        .with_segment_size(memory / RECORD_BYTES)
        .with_sort_dir(to.parent().context("a folder")?.to_owned());
    let sorted = sorter.sort_by_key(records, Record::key);
    let sorted = sorted.map_err(|error| anyhow!("extsort: {error}"))?;
    let mut output = BufWriter::with_capacity(1 << 20, File::create(to)?);
    for record in sorted {
        let record = record.map_err(|error| anyhow!("extsort: {error}"))?;
        output.write_all(&record.0)?;
    }
    Ok(output.into_inner()?.sync_data()?)
}

/// The first eight bytes of a record are its key, the others come with it.
fn queue(from: &Path, to: &Path, memory: usize) -> Result<()> {
    let mut queue = SpillingQueue::new(to.parent().context("a folder")?, memory)?;
    let mut records = BufReader::with_capacity(1 << 20, File::open(from)?);
    for _ in 0..from.metadata()?.len() / RECORD_BYTES as u64 {
        let record = Record::decode(&mut records)?;
        let mut rest = [0; RECORD_BYTES - 8];
        rest.copy_from_slice(&record.0[8..]);
        queue.push(record.key(), rest)?;
    }
    let mut output = BufWriter::with_capacity(1 << 20, File::create(to)?);
    while let Some((key, rest)) = queue.pop()? {
        output.write_all(&key.to_le_bytes())?;
        output.write_all(&rest)?;
    }
    Ok(output.into_inner()?.sync_data()?)
}

/// Reads and writes past the page cache, by large blocks in turn, but for what is less than a page at the end.
fn disk(from: &Path, to: &Path) -> Result<()> {
    const PAGE: usize = 4096;
    const BLOCK: usize = 8 << 20;
    let direct = OFlags::DIRECT.bits() as i32;
    let from = File::options().read(true).custom_flags(direct).open(from)?;
    let to = File::options().write(true).create(true).custom_flags(direct).open(to)?;
    let whole = from.metadata()?.len() / PAGE as u64 * PAGE as u64;
    let mut room = vec![0; BLOCK + PAGE];
    let first = room.as_ptr().align_offset(PAGE);
    for at in (0..whole).step_by(BLOCK) {
        let block = &mut room[first..][..(whole - at).min(BLOCK as u64) as usize];
        from.read_exact_at(block, at)?;
        to.write_all_at(block, at)?;
    }
    Ok(to.sync_data()?)
}

/// Reads and writes, a mebibyte at a time, and brings it to the disk.
fn copy(from: &Path, to: &Path) -> Result<()> {
    let (mut from, mut to) = (File::open(from)?, File::create(to)?);
    let mut block = vec![0; 1 << 20];
    loop {
        match from.read(&mut block)? {
            0 => return Ok(to.sync_data()?),
            read => to.write_all(&block[..read])?,
        }
    }
}
