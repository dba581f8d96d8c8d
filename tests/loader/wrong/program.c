// A position-independent program: an ELF file of the same type as a shared library.
int main(void) { return 0; }
