/* SPDX-License-Identifier: Apache-2.0 */
/* A text that grows in memory, up to a limit; the escapes and the numbers that reports are made of. Nothing here asks the locale. */
#ifndef MCR_STUDY_TEXT_H
#define MCR_STUDY_TEXT_H

#include <stddef.h>
#include <stdint.h>

#define MCR_TEXT_MAX ((size_t)256 << 20)

/* Zeroed at the start. The first failure (memory, the limit) is remembered; what is put later is dropped. */
struct mcr_text {
    char *bytes; /* NUL-terminated once anything was put; owned */
    size_t used, room;
    int failed;
};

void mcr_text_fini(struct mcr_text *text);
void mcr_text_put(struct mcr_text *text, const char *string);
void mcr_text_bytes(struct mcr_text *text, const char *bytes, size_t count);
/* For whole numbers and strings: a double would ask the locale. */
void mcr_text_printf(struct mcr_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What a user wrote, for elements and quoted attributes of HTML that is XML as well. A byte that is not UTF-8 and a character that XML lacks
 * become U+FFFD. NULL is "". */
void mcr_text_html(struct mcr_text *text, const char *string);
/* The same as content of an element whose line may be broken behind each "(". */
void mcr_text_html_breaks(struct mcr_text *text, const char *string);
void mcr_text_base64(struct mcr_text *text, const unsigned char *bytes, size_t count);

/* x with `digits` (1 .. 17) significant ones: 0.00123, 12.3, 1230, 1.23e-5 (below 1e-3 and from 1e6 on); "unknown" for NaN, "infinite". */
void mcr_text_digits(struct mcr_text *text, double x, int digits);
/* The same with at most `digits`, without zeros at the end. */
void mcr_text_short(struct mcr_text *text, double x, int digits);
/* mcr_text_digits for a reader of HTML: a minus sign, 1.23 x 10 to a raised exponent, a dash for NaN. */
void mcr_text_digits_html(struct mcr_text *text, double x, int digits);
/* x with two decimals at most, |x| < 1e12: coordinates, percentages. 0 for NaN. */
void mcr_text_fixed(struct mcr_text *text, double x);

#endif
