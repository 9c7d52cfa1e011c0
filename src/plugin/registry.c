/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE /* secure_getenv */
#include "plugin/registry.h"

#include <dirent.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/elf.h"
#include "plugin/values.h"

#ifndef MCR_PLUGIN_DIR
#define MCR_PLUGIN_DIR "/usr/local/lib/mcrender-1/plugins"
#endif

#define USER_FOLDER "mcrender-1/plugins" /* below $XDG_DATA_HOME */
#define MOST_FOLDERS 64u
#define MOST_FILES 1024u
#define MOST_WORDS 1024u /* of a listing */

struct file {
    const struct mcr_plugin *plugin;
    char *path;
    char *word;      /* of WORD.so in a folder; NULL for a file of --plugin */
    uint32_t folder; /* its number; those of --plugin: UINT32_MAX */
};

struct mcr_registry {
    struct mcr_diagnostics *diagnostics;
    uint32_t isa;
    uint32_t folder_count, user_folder; /* user_folder: its number, or UINT32_MAX */
    char *folder[MOST_FOLDERS];
    uint32_t file_count;
    struct file file[MOST_FILES];
    uint32_t loaded_count, loaded_room;
    struct mcr_loaded *loaded;
};

static const struct mcr_place nowhere;

/* ---- folders and paths ---- */

static char *join(const char *folder, const char *name, const char *suffix)
{
    size_t length = strlen(folder) + 1 + strlen(name) + strlen(suffix) + 1;
    char *path = malloc(length);

    if (path) {
        *path = 0;
        mcr_text_append(path, length, "%s/%s%s", folder, name, suffix);
    }
    return path;
}

/* Takes the string over. */
static void add_folder(struct mcr_registry *registry, char *folder)
{
    if (folder && *folder && registry->folder_count < MOST_FOLDERS)
        registry->folder[registry->folder_count++] = folder;
    else
        free(folder);
}

static void find_folders(struct mcr_registry *registry)
{
    const char *path = secure_getenv("MCRENDER_PLUGIN_PATH"), *data = secure_getenv("XDG_DATA_HOME"), *home = secure_getenv("HOME");
    uint32_t before;

    for (; path && *path; path += strcspn(path, ":"), path += *path == ':')
        add_folder(registry, strndup(path, strcspn(path, ":")));
    before = registry->folder_count;
    if (data && *data == '/') /* the XDG specification has relative ones ignored */
        add_folder(registry, join(data, USER_FOLDER, ""));
    else if (home && *home == '/')
        add_folder(registry, join(home, ".local/share/" USER_FOLDER, ""));
    registry->user_folder = registry->folder_count > before ? before : UINT32_MAX;
    add_folder(registry, strdup(MCR_PLUGIN_DIR));
}

/* A regular file: opening a pipe would wait. */
static int exists(const char *path, struct stat *status)
{
    return stat(path, status) == 0 && S_ISREG(status->st_mode);
}

/* ---- files ---- */

/* Opens and checks. NULL after recording why not. */
static const struct mcr_plugin *open_plugin(struct mcr_registry *registry, const char *path, const char *word, struct mcr_place place,
                                            enum mcr_severity severity)
{
    const struct mcr_plugin *plugin;
    const char *because;
    struct stat status;
    char why[512];
    void *handle;

    if (!exists(path, &status)) {
        mcr_report(registry->diagnostics, severity, place, "no plugin file '%s'", path);
        return NULL;
    }
    if (mcr_elf_is_cut_off(path)) {
        mcr_report(registry->diagnostics, severity, place, "plugin '%s' cannot be loaded: the file is cut off", path);
        return NULL;
    }
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        because = dlerror();
        mcr_report(registry->diagnostics, severity, place, "plugin '%s' cannot be loaded: %s", path, because ? because : "unknown reason");
        return NULL;
    }
    plugin = dlsym(handle, "mcr_plugin");
    if (!plugin)
        mcr_report(registry->diagnostics, severity, place, "'%s' is no plugin: it does not export mcr_plugin", path);
    else if (mcr_plugin_validate(plugin, word, why, sizeof why))
        mcr_report(registry->diagnostics, severity, place, "plugin '%s' is not usable: %s", path, why);
    else
        return plugin;
    return NULL;
}

/* The first file below `folder` in the order that a file of this word hides: another one, not the same by another way. Malloc'd, or NULL. */
static char *hidden_file(const struct mcr_registry *registry, const char *path, uint32_t folder, const char *word)
{
    struct stat mine, other;

    if (!exists(path, &mine))
        return NULL;
    for (uint32_t k = folder + 1; k < registry->folder_count; k++) { /* UINT32_MAX + 1 is 0 */
        char *candidate = join(registry->folder[k], word, ".so");

        if (candidate && exists(candidate, &other) && (other.st_dev != mine.st_dev || other.st_ino != mine.st_ino))
            return candidate;
        free(candidate);
    }
    return NULL;
}

static int compare_loaded(const void *a, const void *b)
{
    const struct mcr_descriptor *left = ((const struct mcr_loaded *)a)->descriptor, *right = ((const struct mcr_loaded *)b)->descriptor;

    if (left->kind != right->kind)
        return left->kind < right->kind ? -1 : 1;
    return strcmp(left->name, right->name);
}

static const struct mcr_loaded *find_loaded(const struct mcr_registry *registry, uint32_t kind_mask, const char *word)
{
    for (uint32_t k = 0; k < registry->loaded_count; k++)
        if (kind_mask & MCR_KIND_MASK(registry->loaded[k].descriptor->kind) && !strcmp(registry->loaded[k].descriptor->name, word))
            return &registry->loaded[k];
    return NULL;
}

/* Whether two descriptors are the same word of the same kind; false for kinds of later versions. */
static int same_word(const struct mcr_descriptor *a, const struct mcr_descriptor *b)
{
    return mcr_descriptor_known(a) && mcr_descriptor_known(b) && a->kind == b->kind && !strcmp(a->name, b->name);
}

/* Adds the baseline descriptors that this file may serve. Returns 0, or -1 when memory is short. */
static int add_loaded(struct mcr_registry *registry, const struct file *file)
{
    const struct mcr_plugin *plugin = file->plugin;

    for (uint32_t k = 0; k < plugin->count; k++) {
        const struct mcr_descriptor *descriptor = plugin->list[k];
        struct mcr_loaded entry = {descriptor, file->path, NULL, 0};

        if (!mcr_descriptor_known(descriptor) || descriptor->isa != MCR_ISA_BASELINE ||
            (file->word && strcmp(file->word, descriptor->name)) ||
            find_loaded(registry, MCR_KIND_MASK(descriptor->kind), descriptor->name))
            continue;
        for (uint32_t j = 0; j < plugin->count; j++)
            if (same_word(descriptor, plugin->list[j]))
                entry.isa_mask |= 1u << plugin->list[j]->isa;
        if (registry->loaded_count == registry->loaded_room) {
            uint32_t room = registry->loaded_room ? 2 * registry->loaded_room : 16;
            struct mcr_loaded *grown = realloc(registry->loaded, room * sizeof *grown);

            if (!grown)
                return -1;
            registry->loaded = grown;
            registry->loaded_room = room;
        }
        entry.hides = hidden_file(registry, file->path, file->folder, descriptor->name);
        if (entry.hides && file->folder != UINT32_MAX && file->folder == registry->user_folder)
            mcr_report(registry->diagnostics, MCR_NOTE, nowhere, "'%s' hides '%s'", file->path, entry.hides);
        registry->loaded[registry->loaded_count++] = entry;
    }
    qsort(registry->loaded, registry->loaded_count, sizeof *registry->loaded, compare_loaded);
    return 0;
}

/* Takes `path` over; word is copied. Returns 0, or -1 after recording why not. */
static int add_file(struct mcr_registry *registry, char *path, const char *word, uint32_t folder, struct mcr_place place,
                    enum mcr_severity severity)
{
    struct file file = {NULL, path, NULL, folder};

    if (path)
        file.plugin = open_plugin(registry, path, word, place, severity);
    file.word = file.plugin && word ? strdup(word) : NULL;
    if (file.plugin && (!word || file.word) && registry->file_count < MOST_FILES) {
        registry->file[registry->file_count++] = file;
        if (add_loaded(registry, &file) == 0)
            return 0;
        mcr_report(registry->diagnostics, MCR_ERROR, place, "out of memory");
        return -1;
    }
    if (!path || file.plugin)
        mcr_report(registry->diagnostics, MCR_ERROR, place, path ? "too many plugin files" : "out of memory");
    free(path);
    free(file.word);
    return -1;
}

struct mcr_registry *mcr_registry_create(struct mcr_diagnostics *diagnostics, uint32_t isa, const char *const *files)
{
    struct mcr_registry *registry = calloc(1, sizeof *registry);

    if (!registry)
        return NULL;
    registry->diagnostics = diagnostics;
    registry->isa = isa;
    find_folders(registry);
    for (; files && *files; files++) /* a bare name is a file here, not one of the system's libraries */
        add_file(registry, strchr(*files, '/') ? strdup(*files) : join(".", *files, ""), NULL, UINT32_MAX, nowhere, MCR_ERROR);
    return registry;
}

void mcr_registry_destroy(struct mcr_registry *registry)
{
    if (!registry)
        return;
    for (uint32_t k = 0; k < registry->folder_count; k++)
        free(registry->folder[k]);
    for (uint32_t k = 0; k < registry->file_count; k++) {
        free(registry->file[k].path);
        free(registry->file[k].word);
    }
    for (uint32_t k = 0; k < registry->loaded_count; k++)
        free((char *)registry->loaded[k].hides);
    free(registry->loaded);
    free(registry);
}

/* ---- words ---- */

static int is_regular(DIR *directory, const char *name)
{
    struct stat status;

    return fstatat(dirfd(directory), name, &status, 0) == 0 && S_ISREG(status.st_mode);
}

/* The words of the files WORD.so in a folder: malloc'd strings added to list[*count..]. */
static void list_folder(const char *folder, char **list, uint32_t *count)
{
    DIR *directory = opendir(folder);
    struct dirent *entry;

    while (directory && (entry = readdir(directory)) && *count < MOST_WORDS) {
        size_t length = strlen(entry->d_name);

        if (length > 3 && !strcmp(entry->d_name + length - 3, ".so") && mcr_word_valid(entry->d_name, length - 3) &&
            is_regular(directory, entry->d_name) && (list[*count] = strndup(entry->d_name, length - 3)))
            ++*count;
    }
    if (directory)
        closedir(directory);
}

static int compare_words(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static const char *kind_name(uint32_t kind_mask)
{
    return kind_mask == MCR_KIND_MASK(MCR_KIND_MATERIAL) ? "material" : kind_mask & MCR_KIND_MASK(MCR_KIND_MATERIAL) ? "plugin" : "sampler";
}

static void report_unknown(struct mcr_registry *registry, uint32_t kind_mask, const char *word, struct mcr_place place)
{
    char *list[MOST_WORDS], text[1024] = "";
    const char *near;
    uint32_t count = 0, kept = 0;

    for (uint32_t k = 0; k < registry->loaded_count && count < MOST_WORDS; k++)
        if ((list[count] = strdup(registry->loaded[k].descriptor->name)))
            count++;
    for (uint32_t k = 0; k < registry->folder_count; k++)
        list_folder(registry->folder[k], list, &count);
    qsort(list, count, sizeof *list, compare_words);
    for (uint32_t k = 0; k < count; k++) {
        if (kept && !strcmp(list[kept - 1], list[k]))
            free(list[k]);
        else
            list[kept++] = list[k];
    }
    mcr_report(registry->diagnostics, MCR_ERROR, place, "unknown %s '%s', expected the name of a plugin", kind_name(kind_mask), word);
    near = mcr_nearest_word(word, (const char *const *)list, kept);
    if (near) {
        mcr_report(registry->diagnostics, MCR_NOTE, place, "did you mean '%s'?", near);
    } else {
        for (uint32_t k = 0; k < kept; k++)
            mcr_text_append(text, sizeof text, "%s%s", k ? ", " : "", list[k]);
        mcr_report(registry->diagnostics, MCR_NOTE, nowhere, "plugins found: %s", kept ? text : "none");
        *text = 0;
        for (uint32_t k = 0; k < registry->folder_count; k++)
            mcr_text_append(text, sizeof text, "%s%s", k ? ", " : "", registry->folder[k]);
        mcr_report(registry->diagnostics, MCR_NOTE, nowhere, "folders searched: %s", text);
    }
    for (uint32_t k = 0; k < kept; k++)
        free(list[k]);
}

/* The best instruction set allowed. */
static const struct mcr_descriptor *choose(const struct mcr_registry *registry, uint32_t kind_mask, const struct mcr_plugin *plugin,
                                           const char *word)
{
    const struct mcr_descriptor *best = NULL;

    for (uint32_t k = 0; k < plugin->count; k++) {
        const struct mcr_descriptor *descriptor = plugin->list[k];

        if (mcr_descriptor_known(descriptor) && kind_mask & MCR_KIND_MASK(descriptor->kind) && !strcmp(descriptor->name, word) &&
            descriptor->isa <= registry->isa && (!best || descriptor->isa > best->isa))
            best = descriptor;
    }
    return best;
}

/* 1: found, 0: there is no such word, -1: an error was recorded. */
static int open_word(struct mcr_registry *registry, const char *word, struct mcr_place place, enum mcr_severity severity)
{
    struct stat status;

    for (uint32_t k = 0; k < registry->file_count; k++)
        if (registry->file[k].word && !strcmp(registry->file[k].word, word))
            return 1;
    for (uint32_t k = 0; k < registry->folder_count; k++) {
        char *path = join(registry->folder[k], word, ".so");

        if (path && exists(path, &status))
            return add_file(registry, path, word, k, place, severity) ? -1 : 1;
        free(path);
    }
    return 0;
}

const struct mcr_descriptor *mcr_registry_find(struct mcr_registry *registry, uint32_t kind_mask, const char *word, struct mcr_place place,
                                               const char **path)
{
    const struct mcr_descriptor *descriptor;
    const struct mcr_loaded *other;
    int opened = 0;

    if (!find_loaded(registry, kind_mask, word) && mcr_word_valid(word, strlen(word)))
        opened = open_word(registry, word, place, MCR_ERROR);
    if (opened < 0)
        return NULL;
    for (uint32_t k = 0; k < registry->file_count; k++) {
        const struct file *file = &registry->file[k];

        if (file->word && strcmp(file->word, word))
            continue;
        descriptor = choose(registry, kind_mask, file->plugin, word);
        if (descriptor) {
            if (path)
                *path = file->path;
            return descriptor;
        }
    }
    other = find_loaded(registry, UINT32_MAX, word);
    if (other)
        mcr_report(registry->diagnostics, MCR_ERROR, place, "'%s' is a %s, expected a %s", word,
                   kind_name(MCR_KIND_MASK(other->descriptor->kind)), kind_name(kind_mask));
    else
        report_unknown(registry, kind_mask, word, place);
    return NULL;
}

void mcr_registry_open_all(struct mcr_registry *registry)
{
    char *list[MOST_WORDS];
    uint32_t count = 0;

    for (uint32_t k = 0; k < registry->folder_count; k++)
        list_folder(registry->folder[k], list, &count);
    qsort(list, count, sizeof *list, compare_words);
    for (uint32_t k = 0; k < count; k++) {
        if ((k == 0 || strcmp(list[k - 1], list[k])) && !find_loaded(registry, UINT32_MAX, list[k]))
            open_word(registry, list[k], nowhere, MCR_WARNING);
    }
    for (uint32_t k = 0; k < count; k++)
        free(list[k]);
}

uint32_t mcr_registry_loaded(const struct mcr_registry *registry, const struct mcr_loaded **list)
{
    *list = registry->loaded;
    return registry->loaded_count;
}

uint32_t mcr_registry_folders(const struct mcr_registry *registry, const char *const **list)
{
    *list = (const char *const *)registry->folder;
    return registry->folder_count;
}
