//! Files of radar instruments, read and written.
