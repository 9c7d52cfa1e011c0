/* SPDX-License-Identifier: Apache-2.0 */
/* Parameters and values as text: for messages, documentation and expressions in normal form. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plugin/values.h"

const struct mcr_parameter *mcr_descriptor_parameter(const struct mcr_descriptor *descriptor, uint32_t k)
{
    return (const struct mcr_parameter *)((const char *)descriptor->parameters + (size_t)k * descriptor->parameters->size);
}

void mcr_text_append(char *text, size_t length, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(text + used, length - used, format, arguments);
    va_end(arguments);
}

void mcr_text_list(char *text, size_t length, const char *word, uint32_t k, uint32_t count)
{
    mcr_text_append(text, length, "%s%s", k == 0 ? "" : k + 1 == count ? " or " : ", ", word);
}

uint32_t mcr_choice_count(const char *choices)
{
    uint32_t count = 1;

    for (; *choices; choices++)
        count += *choices == '|';
    return count;
}

void mcr_choice_word(const char *choices, uint32_t k, char word[MCR_MAX_WORD + 1])
{
    size_t length;

    for (; k > 0 && *choices; choices++)
        k -= *choices == '|';
    length = strcspn(choices, "|");
    length = length < MCR_MAX_WORD ? length : MCR_MAX_WORD;
    memcpy(word, choices, length);
    word[length] = 0;
}

void mcr_text_number(char *text, size_t length, double number)
{
    char digits[32];

    for (int precision = 15; precision <= 17; precision++) { /* fewer digits are within 15: zeros at the end are left out */
        snprintf(digits, sizeof digits, "%.*g", precision, number);
        if (strtod(digits, NULL) == number)
            break;
    }
    mcr_text_append(text, length, "%s", digits);
}

void mcr_range_text(const struct mcr_parameter *parameter, char *text, size_t length)
{
    int above = (parameter->flags & MCR_PARAMETER_ABOVE_MIN) != 0, below = (parameter->flags & MCR_PARAMETER_BELOW_MAX) != 0;
    int low = isfinite(parameter->min), high = isfinite(parameter->max);

    *text = 0;
    if (low && high && !above && !below) {
        mcr_text_number(text, length, parameter->min);
        mcr_text_append(text, length, " to ");
        mcr_text_number(text, length, parameter->max);
    } else {
        if (low) {
            mcr_text_append(text, length, above ? "above " : "at least ");
            mcr_text_number(text, length, parameter->min);
        }
        if (high) {
            mcr_text_append(text, length, "%s%s", low ? " and " : "", below ? "below " : "at most ");
            mcr_text_number(text, length, parameter->max);
        }
        if (!low && !high)
            mcr_text_append(text, length, "a finite number");
    }
    if (*parameter->unit)
        mcr_text_append(text, length, "%s%s", low || high ? " " : ", in ", parameter->unit);
}

void mcr_value_text(const struct mcr_parameter *parameter, const double number[3], char *text, size_t length)
{
    char word[MCR_MAX_WORD + 1];

    *text = 0;
    if (parameter->type == MCR_TYPE_CHOICE) {
        mcr_choice_word(parameter->choices, (uint32_t)number[0], word);
        mcr_text_append(text, length, "%s", word);
    } else if (parameter->type == MCR_TYPE_COLOUR && (number[0] != number[1] || number[0] != number[2])) {
        for (int c = 0; c < 3; c++) {
            mcr_text_append(text, length, c ? ", " : "(");
            mcr_text_number(text, length, number[c]);
        }
        mcr_text_append(text, length, ")");
    } else {
        mcr_text_number(text, length, number[0]);
    }
}
