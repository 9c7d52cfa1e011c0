/* SPDX-License-Identifier: Apache-2.0 */
/* Where images go: new and old files, links, folders, permissions, names, options. What is not a file: tests/image/special.c. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "help.h"

#include <errno.h>
#include <linux/capability.h>
#include <math.h>
#include <sys/syscall.h>
#include <sys/wait.h>

static struct mcr_image *image;
static struct mcr_write_result result;
static const unsigned char expected[] = "P6\n2 1\n255\n\xff\x00\xff\x00\x00\x00";
static char error[512];

static int is_image(const char *path)
{
    return file_is(path, expected, sizeof expected - 1);
}

static int refused(const char *path, const char *reason)
{
    struct mcr_target *target = mcr_target_open(path, error, sizeof error);
    int right = !target && strstr(error, reason) != NULL;
    mcr_target_cancel(target);
    return right;
}

static mode_t mode_of(const char *path)
{
    struct stat status;
    return lstat(path, &status) ? 0 : status.st_mode;
}

static void files(void)
{
    mode_t mask = umask(027);
    ok(!put(in_folder("new.ppm"), image, 0, 0, &result) && is_image(in_folder("new.ppm")), "a new file %s", result.error);
    ok(mode_of(in_folder("new.ppm")) == (S_IFREG | 0640), "has the permissions that the umask leaves");
    spill(in_folder("old.ppm"), "old", 3);
    chmod(in_folder("old.ppm"), 0604);
    ok(!put(in_folder("old.ppm"), image, 0, 0, &result) && is_image(in_folder("old.ppm")), "an old file is replaced %s", result.error);
    ok(mode_of(in_folder("old.ppm")) == (S_IFREG | 0604), "and its permissions stay");
    umask(mask);
    ok(entries(folder) == 2, "nothing else is left in the folder");

    spill(in_folder("old.ppm"), "old", 3);
    struct mcr_target *target = mcr_target_open(in_folder("old.ppm"), error, sizeof error);
    ok(target && file_is(in_folder("old.ppm"), "old", 3) && entries(folder) == 2,
       "while rendering the old file stays and nothing lies beside it");
    mcr_target_cancel(target);
    ok(file_is(in_folder("old.ppm"), "old", 3) && entries(folder) == 2, "and after giving up, too");
    target = mcr_target_open(in_folder("new2.ppm"), error, sizeof error);
    mcr_target_cancel(target);
    ok(target && entries(folder) == 2, "a target that was given up is not made");
    mcr_target_cancel(NULL);

    struct mcr_write_options wrong = {.bits = 12};
    target = mcr_target_open(in_folder("old.ppm"), error, sizeof error);
    ok(mcr_target_write(target, image, &wrong, &result) == -1 && strstr(result.error, "12 bits"), "%s", result.error);
    wrong = (struct mcr_write_options){.exposure = NAN};
    target = mcr_target_open(in_folder("old.ppm"), error, sizeof error);
    ok(mcr_target_write(target, image, &wrong, &result) == -1 && strstr(result.error, "exposure"), "%s", result.error);
    ok(file_is(in_folder("old.ppm"), "old", 3) && entries(folder) == 2, "with options that are refused the old file stays");
}

static void links(void)
{
    char loop[1024];
    mkdir(in_folder("sub"), 0777);
    spill(in_folder("sub/real.ppm"), "old", 3);
    ok(!symlink("sub/real.ppm", in_folder("link.ppm")) && !symlink("link.ppm", in_folder("chain.ppm")), "a chain of links");
    ok(!put(in_folder("chain.ppm"), image, 0, 0, &result) && is_image(in_folder("sub/real.ppm")), "leads to the file that is replaced %s",
       result.error);
    ok(S_ISLNK(mode_of(in_folder("link.ppm"))) && S_ISLNK(mode_of(in_folder("chain.ppm"))) && S_ISREG(mode_of(in_folder("sub/real.ppm"))) &&
           entries(in_folder("sub")) == 1, "the links stay, nothing else appears");
    if (symlink("../sub/later.ppm", in_folder("sub/dangling.ppm"))) perror("symlink");
    ok(!put(in_folder("sub/dangling.ppm"), image, 0, 0, &result) && is_image(in_folder("sub/later.ppm")) &&
           S_ISLNK(mode_of(in_folder("sub/dangling.ppm"))), "a dangling link makes its target");
    if (symlink("missing/x.ppm", in_folder("astray.ppm"))) perror("symlink");
    ok(refused(in_folder("astray.ppm"), "missing': No such file or directory"), "a link into a missing folder: %s", error);
    snprintf(loop, sizeof loop, "%s", in_folder("loop.ppm"));
    if (symlink("loop.ppm", loop)) perror("symlink");
    ok(refused(loop, strerror(ELOOP)), "a link to itself: %s", error);
    if (symlink("sub", in_folder("way"))) perror("symlink");
    ok(!put(in_folder("way/through.ppm"), image, 0, 0, &result) && is_image(in_folder("sub/through.ppm")),
       "a link to a folder in the middle of a path");
    ok(refused(in_folder("way"), "it is a folder"), "a link to a folder at its end: %s", error);
    if (symlink(in_folder("sub/real.ppm"), in_folder("absolute"))) perror("symlink");
    spill(in_folder("sub/real.ppm"), "old", 3);
    ok(!put(in_folder("absolute"), image, 0, 0, &result) && is_image(in_folder("sub/real.ppm")), "an absolute link");
}

static void names(void)
{
    char name[300];
    memset(name, 'n', sizeof name);
    name[255] = '\0';
    ok(!put(in_folder("%s", name), image, 0, 0, &result) && is_image(in_folder("%s", name)), "a name of 255 bytes %s", result.error);
    unlink(in_folder("%s", name));
    name[255] = 'n', name[256] = '\0';
    ok(refused(in_folder("%s", name), strerror(ENAMETOOLONG)), "a name of 256 bytes is refused");
    ok(refused("", "its name is empty"), "no name: %s", error);
    ok(refused(folder, "it is a folder") && refused(in_folder("sub/"), "it is a folder") && refused(in_folder("sub/.."), "it is a folder"),
       "folders: %s", error);
    ok(refused(in_folder("none/"), "it names a folder that does not exist"), "%s", error);
    ok(refused(in_folder("none/x.ppm"), "none': No such file or directory"), "%s", error);
    ok(refused(in_folder("new.ppm/x.ppm"), strerror(ENOTDIR)), "%s", error);
    ok(refused(in_folder("x.gif"), "x.gif': unknown image format '.gif'; known are .ppm and .pfm, and through OpenImageIO .exr"), "%s", error);
    ok(!put(in_folder(".hidden"), image, 0, 0, &result) && is_image(in_folder(".hidden")) && !put(in_folder("dot."), image, 0, 0, &result) &&
           is_image(in_folder("dot.")), "names without an extension are PPM");
    ok(!put(in_folder("new line\n%%s'.ppm"), image, 0, 0, &result), "any byte may stand in a name");
}

/* The folder is kept open: a change of the current one does not move the target. */
static void current_folder(void)
{
    char start[1024];
    if (!getcwd(start, sizeof start) || chdir(in_folder("sub"))) perror("chdir");
    struct mcr_write_options options = {0};
    struct mcr_target *target = mcr_target_open("relative.ppm", error, sizeof error);
    if (chdir(start)) perror("chdir");
    ok(target && !mcr_target_write(target, image, &options, &result) && is_image(in_folder("sub/relative.ppm")),
       "a relative path stays where it was meant");
    target = mcr_target_open(in_folder("sub/turned.ppm"), error, sizeof error);
    mkdir(in_folder("sub/turned.ppm"), 0777);
    ok(mcr_target_write(target, image, &options, &result) == -1 && strstr(result.error, "no longer a regular file"), "%s", result.error);
    rmdir(in_folder("sub/turned.ppm"));
    target = mcr_target_open(in_folder("sub/gone.ppm"), error, sizeof error);
    rename(in_folder("sub"), in_folder("moved"));
    ok(target && !mcr_target_write(target, image, &options, &result) && is_image(in_folder("moved/gone.ppm")),
       "a folder may be renamed meanwhile");
    rename(in_folder("moved"), in_folder("sub"));
}

/* Gives up the right of root to pass over permissions. */
static int be_ordinary(void)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct data[2] = {{0}};
    return syscall(SYS_capset, &header, data) ? -1 : 0;
}

static void permissions(void)
{
    mkdir(in_folder("closed"), 0777);
    spill(in_folder("closed/old.ppm"), "old", 3);
    spill(in_folder("kept.ppm"), "old", 3);
    chmod(in_folder("closed"), 0555);
    chmod(in_folder("kept.ppm"), 0444);
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        if (be_ordinary() || access(in_folder("closed"), W_OK) == 0) _exit(77);
        _exit((put(in_folder("open.ppm"), image, 0, 0, &result) == 0) | refused(in_folder("closed/new.ppm"), strerror(EACCES)) << 1 |
              refused(in_folder("closed/old.ppm"), strerror(EACCES)) << 2 | refused(in_folder("kept.ppm"), strerror(EACCES)) << 3);
    }
    int status = 0;
    waitpid(child, &status, 0);
    status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    static const char *const what[] = {"an open folder is written to", "a folder without write permission is refused before rendering",
                                       "also where the file is there", "a file without write permission is not replaced"};
    for (int i = 0; i < 4; i++) {
        if (status == 77) tap_skip(what[i], "permissions do not bind this process");
        else ok(status >> i & 1, "%s", what[i]);
    }
    ok(file_is(in_folder("kept.ppm"), "old", 3) && file_is(in_folder("closed/old.ppm"), "old", 3), "what was refused is as it was");
    chmod(in_folder("closed"), 0777);
}

int main(void)
{
    static const double values[] = {1, 0, 1, 0, 0, 0};
    enter_folder();
    image = image_of(2, 1, 3, rgb, values);
    files();
    links();
    names();
    current_folder();
    permissions();
    mcr_image_destroy(image);
    leave_folder();
    return tap_done();
}
