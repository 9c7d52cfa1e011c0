/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Finding and loading plugins. WORD.so defines WORD; a scene opens only the files that it names. Order: files given with
 * --plugin, the folders of MCRENDER_PLUGIN_PATH, the user's folder ($XDG_DATA_HOME or ~/.local/share, /mcrender-1/plugins),
 * $(libdir)/mcrender-1/plugins (the macro MCR_PLUGIN_DIR). The first one wins; what it hides is told by mcr_loaded.hides, and by a note where
 * nobody asked for it, in the user's folder. A file given with --plugin may have any name and defines all its words; WORD.so in a folder is
 * taken for WORD alone. Files are opened with RTLD_NOW | RTLD_LOCAL and never closed. A program with raised privileges (secure_getenv)
 * looks at neither the environment nor the user's folder. Main thread only.
 */
#ifndef MCR_PLUGIN_REGISTRY_H
#define MCR_PLUGIN_REGISTRY_H

#include "base/diag.h"
#include <mcrender/plugin.h>

struct mcr_registry;

/*
 * isa: MCR_ISA_*, the highest that may be chosen. files: those of --plugin, NULL-terminated, may be NULL; they are opened now and
 * what is wrong with them is recorded as errors. NULL when memory is short.
 */
struct mcr_registry *mcr_registry_create(struct mcr_diagnostics *diagnostics, uint32_t isa, const char *const *files);
void mcr_registry_destroy(struct mcr_registry *registry);

/*
 * The descriptor of this kind and word for the best instruction set allowed, its file opened at need. NULL when there is none:
 * an error was recorded at `place`, with the nearest word, or else with the words that exist and the folders searched.
 * path, if not NULL, is set to the file's name (the registry's).
 */
const struct mcr_descriptor *mcr_registry_find(struct mcr_registry *registry, uint32_t kind_mask, const char *word, struct mcr_place place,
                                               const char **path);
#define MCR_KIND_MASK(kind) (1u << (kind))

/* Opens every plugin that can be found. Files that do not load are reported as warnings. */
void mcr_registry_open_all(struct mcr_registry *registry);

/* What is loaded so far, baseline descriptors only, sorted by kind and word: for `mcrender plugins` and the report. */
struct mcr_loaded {
    const struct mcr_descriptor *descriptor;
    const char *path;
    const char *hides; /* a file further down the order that would have been taken without this one, or NULL */
    uint32_t isa_mask; /* 1 << MCR_ISA_* for each instruction set offered */
};
uint32_t mcr_registry_loaded(const struct mcr_registry *registry, const struct mcr_loaded **list);
/* The folders that are searched, in order. */
uint32_t mcr_registry_folders(const struct mcr_registry *registry, const char *const **list);

/*
 * Checks a plugin's tables by themselves, as loading does: sizes, names, ranges, defaults, operations. word: one of its descriptors must
 * have this name; NULL: any will do. Returns 0, or -1 with the reason in `why`.
 */
int mcr_plugin_validate(const struct mcr_plugin *plugin, const char *word, char *why, size_t length);
/* Whether kind and instruction set are among those of this header; others come from a later minor version and are left alone. */
int mcr_descriptor_known(const struct mcr_descriptor *descriptor);
/* Whether the bytes are a word: [a-z][a-z0-9_-]*, at most 64. */
int mcr_word_valid(const char *word, size_t length);

#endif
