//! Error rates of verification and identification by the conventions of ISO/IEC 19795, with intervals.
