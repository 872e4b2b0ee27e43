/* Statuses: all that follows from their list in the public header. */
#include "run.h"

#include <stddef.h>

#define ROW(name, number, error, sentence) {number, #name, error, sentence},
static const zd_status_row rows[] = {ZD_STATUS_LIST(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

const zd_status_row *zd_status_at(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

const char *zd_sentence(int status)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].status == status) return rows[i].sentence;
    return "an unknown status";
}
