//! Building connectivity from index buffers and from gluings.
