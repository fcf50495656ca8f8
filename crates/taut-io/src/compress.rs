//! Streams that are compressed as a whole.

use std::io::{self, BufRead, BufReader, Read, Write};

use crate::{Compression, Error};

const BUFFER_BYTES: usize = 1 << 18;

/// Reads `stream` through the decoder; a file of several members is read to its last.
pub(crate) fn decoder(
    compression: Compression,
    stream: Box<dyn BufRead>,
    path: &str,
) -> Result<Box<dyn BufRead>, Error> {
    let inner: Box<dyn Read> = match compression {
        Compression::Gzip => Box::new(flate2::bufread::MultiGzDecoder::new(stream)),
        Compression::Xz => Box::new(liblzma::bufread::XzDecoder::new_multi_decoder(stream)),
        Compression::Zstd => Box::new(
            zstd::stream::read::Decoder::with_buffer(stream)
                .map_err(|source| Error::reading(path, source))?,
        ),
    };
    let named = Named { inner, path: path.to_owned(), compression };
    Ok(Box::new(BufReader::with_capacity(BUFFER_BYTES, named)))
}

/// Says of each error of a decoder which file and which compression it is about.
struct Named {
    inner: Box<dyn Read>,
    path: String,
    compression: Compression,
}

impl Read for Named {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.inner.read(buffer).map_err(|source| match source.kind() {
            io::ErrorKind::Interrupted => source,
            _ => io::Error::other(Error::Compressed {
                path: self.path.clone(),
                compression: self.compression,
                source,
            }),
        })
    }
}

/// A writer whose [`finish`](Self::finish) ends the compressed stream, if there is one.
pub(crate) enum Encoder<W: Write> {
    Plain(W),
    Gzip(flate2::write::GzEncoder<W>),
    Xz(liblzma::write::XzEncoder<W>),
    Zstd(zstd::stream::write::Encoder<'static, W>),
}

impl<W: Write> Encoder<W> {
    /// The usual level of each tool: 6 for gzip and xz, 3 for zstd.
    pub(crate) fn new(compression: Option<Compression>, to: W) -> io::Result<Self> {
        Ok(match compression {
            None => Encoder::Plain(to),
            Some(Compression::Gzip) => {
                Encoder::Gzip(flate2::write::GzEncoder::new(to, flate2::Compression::new(6)))
            }
            Some(Compression::Xz) => Encoder::Xz(liblzma::write::XzEncoder::new(to, 6)),
            Some(Compression::Zstd) => {
                let mut encoder = zstd::stream::write::Encoder::new(to, 3)?;
                // As the zstd tool does; else a changed byte could pass for another number.
                encoder.include_checksum(true)?;
                Encoder::Zstd(encoder)
            }
        })
    }

    pub(crate) fn finish(self) -> io::Result<W> {
        match self {
            Encoder::Plain(to) => Ok(to),
            Encoder::Gzip(encoder) => encoder.finish(),
            Encoder::Xz(encoder) => encoder.finish(),
            Encoder::Zstd(encoder) => encoder.finish(),
        }
    }

    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Encoder::Plain(to) => to,
            Encoder::Gzip(encoder) => encoder,
            Encoder::Xz(encoder) => encoder,
            Encoder::Zstd(encoder) => encoder,
        }
    }
}

impl<W: Write> Write for Encoder<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer().flush()
    }
}
