#include "point.h"

#include <stdio.h>

const char *zd_name_row(const zd_system *system, int row, char to[ZD_ROW_NAME])
{
    char name[ZD_ROW_NAME - 16] = "";
    if (system->name_constraint) system->name_constraint(system->names, row, name, (int)sizeof name);
    if (*name) snprintf(to, ZD_ROW_NAME, "%d '%s'", row, name);
    else snprintf(to, ZD_ROW_NAME, "%d", row);
    return to;
}
