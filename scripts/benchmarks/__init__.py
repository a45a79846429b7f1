"""The rules for benchmarks of SMT-LIB and SMT-COMP, checked on what is really written in a file."""
