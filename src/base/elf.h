/* SPDX-License-Identifier: Apache-2.0 */
/* Shared objects, before they are handed to the dynamic linker. */
#ifndef MCR_BASE_ELF_H
#define MCR_BASE_ELF_H

/*
 * Whether a file begins like an ELF file of this machine's word size, but lacks a part of what its program headers say is to be loaded: a copy
 * that was not finished. dlopen maps such files, and the process ends by SIGBUS. 0 for anything else, which dlopen refuses by itself.
 */
int mcr_elf_is_cut_off(const char *path);

#endif
