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
        #[cfg(feature = "xz")]
        Compression::Xz => Box::new(liblzma::bufread::XzDecoder::new_multi_decoder(stream)),
        #[cfg(feature = "zstd")]
        Compression::Zstd => Box::new(
            zstd::stream::read::Decoder::with_buffer(stream)
                .map_err(|source| Error::reading(path, source))?,
        ),
        #[cfg(not(all(feature = "xz", feature = "zstd")))]
        left_out => return Err(Error::not_built(path, left_out)),
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
    #[cfg(feature = "xz")]
    Xz(liblzma::write::XzEncoder<W>),
    #[cfg(feature = "zstd")]
    Zstd(zstd::stream::write::Encoder<'static, W>),
}

impl<W: Write> Encoder<W> {
    /// The usual level of each tool: 6 for gzip and xz, 3 for zstd.
    ///
    /// `path` and `failure` say what an error of the encoder means.
    pub(crate) fn new(
        compression: Option<Compression>,
        to: W,
        path: &str,
        failure: fn(&str, io::Error) -> Error,
    ) -> Result<Self, Error> {
        let made: io::Result<Self> = match compression {
            None => Ok(Encoder::Plain(to)),
            Some(Compression::Gzip) => {
                let level = flate2::Compression::new(6);
                Ok(Encoder::Gzip(flate2::write::GzEncoder::new(to, level)))
            }
            #[cfg(feature = "xz")]
            Some(Compression::Xz) => Ok(Encoder::Xz(liblzma::write::XzEncoder::new(to, 6))),
            #[cfg(feature = "zstd")]
            Some(Compression::Zstd) => zstd_encoder(to).map(Encoder::Zstd),
            #[cfg(not(all(feature = "xz", feature = "zstd")))]
            Some(left_out) => return Err(Error::not_built(path, left_out)),
        };
        made.map_err(|source| failure(path, source))
    }

    pub(crate) fn finish(self) -> io::Result<W> {
        match self {
            Encoder::Plain(to) => Ok(to),
            Encoder::Gzip(encoder) => encoder.finish(),
            #[cfg(feature = "xz")]
            Encoder::Xz(encoder) => encoder.finish(),
            #[cfg(feature = "zstd")]
            Encoder::Zstd(encoder) => encoder.finish(),
        }
    }

    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Encoder::Plain(to) => to,
            Encoder::Gzip(encoder) => encoder,
            #[cfg(feature = "xz")]
            Encoder::Xz(encoder) => encoder,
            #[cfg(feature = "zstd")]
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

#[cfg(feature = "zstd")]
fn zstd_encoder<W: Write>(to: W) -> io::Result<zstd::stream::write::Encoder<'static, W>> {
    let mut encoder = zstd::stream::write::Encoder::new(to, 3)?;
    // As the zstd tool does; else a changed byte could pass for another number.
    encoder.include_checksum(true)?;
    Ok(encoder)
}
