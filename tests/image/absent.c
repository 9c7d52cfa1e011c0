/* SPDX-License-Identifier: Apache-2.0 */
/* Without the OpenImageIO module, or with one that is none: clear errors, and what we do ourselves goes on. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "help.h"

#include <dlfcn.h>
#include <sys/wait.h>

static char error[512];
static const double white[] = {1, 1, 1};

/* Each question needs a process of its own: the answer of the module is kept. */
static int in_child(const char *path, int (*body)(void))
{
    int status = -1;
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        setenv("MCRENDER_MODULE_PATH", path, 1);
        status = body();
        if (!status) printf("# %s\n", error);
        fflush(stdout);
        _exit(status);
    }
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
}

static int refused(const char *reason)
{
    struct mcr_target *target = mcr_target_open(in_folder("a.exr"), error, sizeof error);
    if (target || !strstr(error, "a.exr': .exr needs OpenImageIO, which is not available: ") || !strstr(error, reason)) return 0;
    return !mcr_image_module(error, sizeof error) && strstr(error, reason);
}

static int exr_missing(void) { return refused("no oiio.so in") && strstr(error, "MCRENDER_MODULE_PATH") ? 0 : 1; }
static int exr_garbage(void) { return refused("cannot load it:") ? 0 : 1; }
static int exr_foreign(void) { return refused("is not a module of mcrender") ? 0 : 1; }

static int unknown(void)
{
    return !mcr_target_open(in_folder("a.xyz"), error, sizeof error) && strstr(error, "unknown image format '.xyz'") && strstr(error,
        "not installed") ? 0 : 1;
}

static int reading(void)
{
    spill(in_folder("a.png"), "\x89PNG\r\n\x1a\n", 8);
    return !mcr_image_read(in_folder("a.png"), error, sizeof error) && strstr(error,
        "its format (png) needs OpenImageIO, which is not available") ? 0 : 1;
}

static int own_formats(void)
{
    struct mcr_write_result result;
    struct mcr_image *image = image_of(1, 1, 3, rgb, white);
    if (put(in_folder("a.ppm"), image, 0, 0, &result) || put(in_folder("a.pfm"), image, 0, 0, &result)) return 1;
    struct mcr_image *ppm = mcr_image_read(in_folder("a.ppm"), error, sizeof error);
    struct mcr_image *pfm = mcr_image_read(in_folder("a.pfm"), error, sizeof error);
    int failed = !ppm || !pfm || ppm->data[1] != 1 || pfm->data[1] != 1;
    mcr_image_destroy(image);
    mcr_image_destroy(ppm);
    mcr_image_destroy(pfm);
    return failed;
}

int main(void)
{
    enter_folder();
    mkdir(in_folder("empty"), 0777);
    mkdir(in_folder("garbage"), 0777);
    mkdir(in_folder("foreign"), 0777);
    spill(in_folder("garbage/oiio.so"), "this is no library", 18);
    Dl_info library;
    int linked = dladdr((void *)(uintptr_t)strerror, &library) && library.dli_fname[0] == '/' &&
        !symlink(library.dli_fname, in_folder("foreign/oiio.so"));

    ok(!in_child(in_folder("empty"), exr_missing), "an empty folder of modules: EXR is refused before rendering");
    ok(!in_child(in_folder("no such folder"), exr_missing), "a missing one, too");
    ok(!in_child("::", exr_missing), "no current folder hides in an empty element");
    ok(!in_child(in_folder("garbage"), exr_garbage), "a module that is no library");
    if (linked) ok(!in_child(in_folder("foreign"), exr_foreign), "a library that is no module");
    else tap_skip("a library that is no module", "the C library's file is not known");
    ok(!in_child(in_folder("empty"), unknown), "an unknown extension: the error tells that OpenImageIO is not installed");
    ok(!in_child(in_folder("empty"), reading), "reading PNG is refused");
    ok(!in_child(in_folder("empty"), own_formats), "PPM and PFM are written and read");
    ok(access(in_folder("a.exr"), F_OK) != 0, "no file was made");
    leave_folder();
    return tap_done();
}
