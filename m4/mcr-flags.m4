dnl SPDX-License-Identifier: Apache-2.0
dnl MCR_FLAG(VARIABLE, FLAGS, [IF-REFUSED])
dnl Appends FLAGS to VARIABLE if the compiler of the current language takes them. -Werror because clang only warns about an
dnl optimisation flag that it ignores. The user's CFLAGS are not touched.
AC_DEFUN([MCR_FLAG],
[AC_MSG_CHECKING([whether $[]_AC_CC takes $2])
mcr_saved=$[]_AC_LANG_PREFIX[]FLAGS
_AC_LANG_PREFIX[]FLAGS="$mcr_saved -Werror $2"
AC_COMPILE_IFELSE([AC_LANG_PROGRAM([[double mcr_probe(double x);]], [[]])],
  [AC_MSG_RESULT([yes])
   $1="${$1:+${$1} }$2"],
  [AC_MSG_RESULT([no])
   $3])
_AC_LANG_PREFIX[]FLAGS=$mcr_saved])

dnl MCR_TRISTATE(NAME, DEFAULT, WHAT)
dnl --with-NAME=auto|yes|no in the variable with_NAME.
AC_DEFUN([MCR_TRISTATE],
[AC_ARG_WITH([$1],
  [AS_HELP_STRING([--with-$1=auto|yes|no], [$3 @<:@default: $2@:>@])],
  [AS_CASE([$withval], [auto|yes|no], [], [AC_MSG_ERROR([--with-$1: expected auto, yes or no, got "$withval"])])],
  [with_$1=$2])])
