// What the module offers, under the name by which it is looked up.
#include "src/import/import_module.h"
#include "src/import/module/hdf5_log.h"
#include "src/import/module/mat_log.h"
#include "src/import/module/rosbag2_log.h"

extern "C" const fidservo::imports::ImportModule fidservo_import_module;

const fidservo::imports::ImportModule fidservo_import_module{
    fidservo::imports::read_mat_file, fidservo::imports::read_hdf5_file, fidservo::imports::read_rosbag2_file,
    fidservo::imports::write_mat_file, fidservo::imports::write_hdf5_file};
